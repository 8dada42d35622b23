#include "calibration/lens_fit.h"

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "geometry/camera.h"

namespace lumibox::calibration {
namespace {

struct OpencvPoints {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> in_picture;
};

OpencvPoints to_opencv(const Board& board, std::span<const Sighting> sightings) {
  OpencvPoints points;
  for (const Sighting& sighting : sightings) {
    auto& on_board = points.on_board.emplace_back();
    auto& in_picture = points.in_picture.emplace_back();
    for (const Corner& corner : sighting) {
      const Eigen::Vector2f place = corner_on_board(board, corner.id).cast<float>();
      const Eigen::Vector2f pixel = corner.pixel.cast<float>();
      on_board.emplace_back(place.x(), place.y(), 0.0F);
      in_picture.emplace_back(pixel.x(), pixel.y());
    }
  }
  return points;
}

geometry::Pose to_pose(const cv::Mat& rotation, const cv::Mat& translation) {
  const auto vector = [](const cv::Mat& m) {
    return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  return {geometry::exp_so3(vector(rotation)), vector(translation)};
}

/// What OpenCV found, in its own terms.
struct Found {
  cv::Mat matrix;
  cv::Mat distortion;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
};

/// What OpenCV iterates until.
cv::TermCriteria convergence() {
  return {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12};
}

/// None if OpenCV refuses: its way to say that the views do not determine a lens.
std::optional<Found> solve_opencv(const OpencvPoints& points, cv::Size size) {
  Found found;
  try {
    cv::calibrateCamera(points.on_board, points.in_picture, size, found.matrix, found.distortion,
                        found.rotations, found.translations, 0, convergence());
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return found;
}

/// cv::fisheye::calibrate ends in an assertion or stops early when its first focal length is far
/// off, so it is started from fields of view all over the range, and the best end wins.
std::optional<Found> solve_fisheye(const OpencvPoints& points, cv::Size size) {
  constexpr int kFlags = cv::fisheye::CALIB_USE_INTRINSIC_GUESS |
                         cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW;
  std::optional<Found> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double field_of_view : {1.0, 1.5, 2.0, 2.5, 3.0}) {  // radians across the width
    const double f = size.width / field_of_view;
    Found found;
    found.matrix = (cv::Mat_<double>(3, 3) << f, 0.0, 0.5 * (size.width - 1), 0.0, f,
                    0.5 * (size.height - 1), 0.0, 0.0, 1.0);
    found.distortion = cv::Mat::zeros(4, 1, CV_64F);
    try {
      const double error = cv::fisheye::calibrate(points.on_board, points.in_picture, size,
                                                  found.matrix, found.distortion, found.rotations,
                                                  found.translations, kFlags, convergence());
      if (error < least) {
        least = error;
        best = found;
      }
    } catch (const cv::Exception&) {
      continue;  // the next start may do
    }
  }
  return best;
}

config::CameraProfile profile_of(const Found& found, int width, int height,
                                 config::LensModel model) {
  config::CameraProfile c;
  c.model = model;
  c.width = width;
  c.height = height;
  c.fx = found.matrix.at<double>(0, 0);
  c.fy = found.matrix.at<double>(1, 1);
  c.cx = found.matrix.at<double>(0, 2);
  c.cy = found.matrix.at<double>(1, 2);
  const auto coefficient = [&found](int i) { return found.distortion.at<double>(i); };
  c.k1 = coefficient(0);
  c.k2 = coefficient(1);
  if (model == config::LensModel::Fisheye) {
    c.k3 = coefficient(2);
    c.k4 = coefficient(3);
  } else {
    c.p1 = coefficient(2);
    c.p2 = coefficient(3);
    c.k3 = coefficient(4);
  }
  return c;
}

}  // namespace

std::optional<LensFit> fit_lens(const Board& board, std::span<const Sighting> sightings, int width,
                                int height, config::LensModel model) {
  const OpencvPoints points = to_opencv(board, sightings);
  const auto found = model == config::LensModel::Fisheye ? solve_fisheye(points, {width, height})
                                                         : solve_opencv(points, {width, height});
  if (!found) return std::nullopt;
  LensFit fit;
  fit.profile = profile_of(*found, width, height, model);
  if (config::fault_of(fit.profile)) return std::nullopt;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    fit.camera_from_board.push_back(to_pose(found->rotations[i], found->translations[i]));
  }
  return fit;
}

double error_px(const Board& board, const Sighting& sighting, const config::CameraProfile& profile,
                const geometry::Pose& camera_from_board) {
  const geometry::Camera camera(profile);
  double sum = 0.0;
  for (const Corner& corner : sighting) {
    const Eigen::Vector2d place = corner_on_board(board, corner.id);
    const auto pixel = camera.project(camera_from_board * Eigen::Vector3d(place.x(), place.y(), 0));
    if (!pixel) return std::numeric_limits<double>::infinity();
    sum += (*pixel - corner.pixel).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(sighting.size()));
}

}  // namespace lumibox::calibration
