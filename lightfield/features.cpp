#include "lightfield/features.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>

namespace lumibox::lightfield {
namespace {

constexpr int kLongerSide = 1000;         // pixels, of the picture that features are sought in
constexpr int kSmallestSide = 16;         // pixels: below it there is no room for a descriptor
constexpr double kToleranceShare = 2e-3;  // of the longer side: what poses of others are good to
constexpr double kMinTolerance = 1.0;     // pixels: SIFT's own error and some more
constexpr double kContrast = 0.007;       // Lowe's is 0.04, but walls and floors count, too
constexpr double kEdge = 10.0;            // Lowe's
constexpr int kCells = 24;                // along the longer side, to spread features over
// OpenCV doubles the picture first and takes pixel 2x for x, where its interpolation has put what
// belongs to x - 1/4.
constexpr float kDoublingShift = 0.25F;

/// A perspective's grey picture, reduced by `factor`.
struct Reduced {
  cv::Mat gray;
  double factor = 1.0;

  Eigen::Vector2d pixel_of_original(const cv::Point2f& place) const {
    return {(place.x - kDoublingShift + 0.5) * factor - 0.5,
            (place.y - kDoublingShift + 0.5) * factor - 0.5};
  }
};

Reduced reduce(const hal::Image& color) {
  const hal::Image gray = hal::to_gray(color);
  const cv::Mat view(gray.height(), gray.width(), CV_8UC1, const_cast<std::uint8_t*>(gray.data()));
  const int longer = std::max(gray.width(), gray.height());
  Reduced reduced;
  reduced.factor = std::max(1.0, static_cast<double>(longer) / kLongerSide);
  if (longer <= kLongerSide) {
    reduced.gray = view.clone();
  } else {
    const double share = 1.0 / reduced.factor;
    cv::resize(view, reduced.gray, {}, share, share, cv::INTER_AREA);
  }
  return reduced;
}

/// SIFT finds a place once per direction that its gradients have; one is enough here.
void keep_one_per_place(std::vector<cv::KeyPoint>& found) {
  const auto key = [](const cv::KeyPoint& k) { return std::tuple(k.pt.x, k.pt.y, k.size); };
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return std::tuple(key(a), a.angle) < std::tuple(key(b), b.angle);
  });
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const auto& a, const auto& b) { return key(a) == key(b); }),
              found.end());
}

/// The strongest of every cell of the picture come first, then the second of every cell, and so on.
void keep_spread(std::vector<cv::KeyPoint>& found, double cell_px, std::size_t limit) {
  if (found.size() <= limit) return;
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.response > b.response; });
  std::map<std::pair<int, int>, int> taken;
  for (cv::KeyPoint& k : found) {
    k.class_id = taken[{static_cast<int>(k.pt.x / cell_px), static_cast<int>(k.pt.y / cell_px)}]++;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.class_id < b.class_id; });
  found.resize(limit);
}

/// Direction in the picture, in degrees from x towards y, that `up_in_camera` has at a bearing.
float upright_deg(const geometry::Camera& camera, const Eigen::Vector3d& bearing,
                  const Eigen::Vector3d& up_in_camera) {
  Eigen::Matrix<double, 2, 3> pixel_by_point;
  if (!camera.project(bearing, &pixel_by_point)) return 0.0F;
  const Eigen::Vector2d direction = pixel_by_point * up_in_camera;
  const double angle = std::atan2(direction.y(), direction.x()) * 180.0 / std::numbers::pi;
  return static_cast<float>(angle < 0.0 ? angle + 360.0 : angle);
}

/// Where features lie, and upright; those that the lens does not explain are left out.
Features place_features(const Perspective& perspective, const Eigen::Vector3d& up_in_world,
                        const Reduced& reduced, std::vector<cv::KeyPoint>& found) {
  const Eigen::Vector3d up_in_camera =
      perspective.world_from_camera.rotation.conjugate() * up_in_world;
  Features features;
  std::vector<cv::KeyPoint> placed;
  for (cv::KeyPoint& k : found) {
    const Eigen::Vector2d pixel = reduced.pixel_of_original(k.pt);
    const auto normalised = perspective.camera->unproject(pixel);
    if (!normalised) continue;
    features.pixels.push_back(pixel);
    features.bearings.push_back(normalised->homogeneous().normalized());
    k.angle = upright_deg(*perspective.camera, features.bearings.back(), up_in_camera);
    placed.push_back(k);
  }
  found = std::move(placed);
  return features;
}

}  // namespace

Features find_features(const Perspective& perspective, const Eigen::Vector3d& up_in_world,
                       std::size_t limit) {
  const Reduced reduced = reduce(*perspective.photo->require_rgb());
  if (std::min(reduced.gray.cols, reduced.gray.rows) < kSmallestSide) return {};
  const int longer = std::max(reduced.gray.cols, reduced.gray.rows);
  const auto sift = cv::SIFT::create(0, 3, kContrast, kEdge, 1.6, CV_8U);
  std::vector<cv::KeyPoint> found;
  sift->detect(reduced.gray, found);
  keep_one_per_place(found);
  keep_spread(found, static_cast<double>(longer) / kCells, limit);

  Features features = place_features(perspective, up_in_world, reduced, found);
  features.tolerance_px = reduced.factor * std::max(kMinTolerance, kToleranceShare * longer);
  const config::CameraProfile& lens = perspective.camera->profile();
  features.tolerance_rad = features.tolerance_px / std::sqrt(lens.fx * lens.fy);
  if (found.empty()) return features;
  cv::Mat descriptors;
  sift->compute(reduced.gray, found, descriptors);
  features.descriptors.resize(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::memcpy(features.descriptors[i].data(), descriptors.ptr(static_cast<int>(i)),
                sizeof(Descriptor));
  }
  return features;
}

}  // namespace lumibox::lightfield
