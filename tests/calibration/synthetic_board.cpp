#include "calibration/synthetic_board.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/aruco/charuco.hpp>
#include <random>

#include "geometry/camera.h"

namespace lumibox::test {
namespace {

using calibration::Board;

/// Not std::normal_distribution: its values differ between standard libraries.
class Gaussian {
 public:
  explicit Gaussian(std::uint32_t seed) : generator_(seed) {}
  double next() {  // Box and Muller
    const double u = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  double uniform() { return (static_cast<double>(generator_()) + 0.5) / 4294967296.0; }
  std::mt19937 generator_;
};

/// The board's print, one pixel per millimetre and more, with its squares' outermost corner first.
constexpr int kPixelsPerSquare = 60;

hal::Image print(const Board& board) {
  const int width = (board.columns + 1) * kPixelsPerSquare;
  const int height = (board.rows + 1) * kPixelsPerSquare;
  hal::Image image(width, height, 1);
  if (board.markers) {
    const auto place = std::ranges::find(calibration::dictionaries(), board.markers->dictionary);
    cv::Mat drawn;
    cv::aruco::CharucoBoard::create(
        board.columns + 1, board.rows + 1, static_cast<float>(board.square_m),
        static_cast<float>(board.markers->side_m),
        cv::aruco::getPredefinedDictionary(
            static_cast<int>(place - calibration::dictionaries().begin())))
        ->draw({width, height}, drawn);
    std::copy_n(drawn.data, image.size_bytes(), image.data());
    return image;
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      *image.at(x, y) = (x / kPixelsPerSquare + y / kPixelsPerSquare) % 2 == 0 ? 20 : 235;
    }
  }
  return image;
}

}  // namespace

config::CameraProfile webcam() {
  config::CameraProfile c;
  c.fx = 533.0;
  c.fy = 535.0;
  c.cx = 324.0;
  c.cy = 236.0;
  c.k1 = -0.28;
  c.k2 = 0.08;
  c.p1 = 0.001;
  c.p2 = -0.0005;
  c.k3 = -0.01;
  return c;
}

config::CameraProfile fisheye_camera() {
  config::CameraProfile c;
  c.model = config::LensModel::Fisheye;
  c.fx = 285.0;
  c.fy = 286.0;
  c.cx = 322.0;
  c.cy = 238.0;
  c.k1 = -0.01;
  c.k2 = 0.004;
  c.k3 = -0.003;
  c.k4 = 0.0006;
  return c;
}

std::vector<geometry::Pose> varied_poses(const Board& board, const config::CameraProfile& profile,
                                         int count, double tilt_deg) {
  const geometry::Camera camera(profile);
  const Eigen::Vector2d last = corner_on_board(board, board.columns * board.rows - 1);
  const Eigen::Vector3d middle(0.5 * last.x(), 0.5 * last.y(), 0.0);
  std::vector<geometry::Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double u = profile.width * (0.2 + 0.3 * (i % 3));
    const double v = profile.height * (0.2 + 0.3 * (i / 3 % 3));
    const Eigen::Vector3d ray = camera.unproject({u, v})->homogeneous().normalized();
    const double share = 0.4 + 0.2 * (i % 4);
    const double about = 2.4 * i;  // the golden angle: no two axes alike
    const Eigen::Vector3d axis(std::cos(about), std::sin(about), 0.0);
    const Eigen::Quaterniond tilt =
        geometry::exp_so3(share * tilt_deg * std::numbers::pi / 180.0 * axis);
    const double distance = last.norm() * profile.fx / profile.width * (1.9 + 0.25 * (i % 5));
    poses.emplace_back(tilt, distance * ray - tilt * middle);
  }
  return poses;
}

calibration::Sighting observe(const Board& board, const config::CameraProfile& profile,
                              const geometry::Pose& camera_from_board, double noise_px,
                              std::uint32_t seed) {
  const geometry::Camera camera(profile);
  Gaussian noise(seed);
  calibration::Sighting sighting;
  for (int id = 0; id < board.columns * board.rows; ++id) {
    const Eigen::Vector2d place = corner_on_board(board, id);
    const auto pixel = camera.project(camera_from_board * Eigen::Vector3d(place.x(), place.y(), 0));
    if (!pixel || !camera.contains(*pixel)) continue;
    const double x = noise_px * noise.next();
    sighting.push_back({id, *pixel + Eigen::Vector2d(x, noise_px * noise.next())});
  }
  return sighting;
}

std::vector<calibration::Sighting> observe_all(const Board& board,
                                               const config::CameraProfile& camera,
                                               const std::vector<geometry::Pose>& poses,
                                               double noise_px, std::uint32_t seed) {
  std::vector<calibration::Sighting> sightings;
  for (const geometry::Pose& pose : poses) {
    const auto own = seed + 1000 * static_cast<std::uint32_t>(sightings.size());
    sightings.push_back(observe(board, camera, pose, noise_px, own));
  }
  return sightings;
}

hal::Image picture_of(const Board& board, const config::CameraProfile& profile,
                      const geometry::Pose& camera_from_board) {
  constexpr int kSamples = 4;  // each way, for soft edges
  const geometry::Camera camera(profile);
  const hal::Image paper = print(board);
  const geometry::Pose board_from_camera = camera_from_board.inverse();
  const Eigen::Vector3d eye = board_from_camera.translation;
  hal::Image image(profile.width, profile.height, 1);
  for (int y = 0; y < profile.height; ++y) {
    for (int x = 0; x < profile.width; ++x) {
      double sum = 0.0;
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const Eigen::Vector2d pixel(x + (s % kSamples + 0.5) / kSamples - 0.5,
                                    y + (s / kSamples + 0.5) / kSamples - 0.5);
        const auto ray = camera.unproject(pixel);
        double grey = 200.0;
        if (ray) {
          const Eigen::Vector3d way = board_from_camera.rotation * ray->homogeneous();
          const Eigen::Vector3d on_board = eye - eye.z() / way.z() * way;
          const Eigen::Vector2d at =
              kPixelsPerSquare * (on_board.head<2>() / board.square_m + Eigen::Vector2d::Ones());
          const bool inside =
              at.x() >= 0 && at.y() >= 0 && at.x() < paper.width() && at.y() < paper.height();
          if (inside) grey = *paper.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
        }
        sum += grey;
      }
      *image.at(x, y) = static_cast<std::uint8_t>(std::lround(sum / (kSamples * kSamples)));
    }
  }
  return image;
}

}  // namespace lumibox::test
