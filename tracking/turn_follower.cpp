#include "tracking/turn_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tracking/corners.h"

namespace lumibox::tracking {
namespace {

constexpr int kCorners = 300;                             // per picture of the panorama
constexpr int kMinInliers = 25;                           // fewer may agree by chance
constexpr double kMinShare = 0.4;                         // of the points looked for
constexpr double kStep = 8.0 * std::numbers::pi / 180.0;  // of the turn, to the next picture
constexpr int kCell = 32;                                 // pixels, with one corner at most

LocalisationPasses passes(const config::Tracking& options) {
  return {.coarse_points = 60,
          .min_coarse = 0,
          .coarse_radius = 6.0,
          .wide_radius = 0.0,
          .fine_points = 200,
          .fine_radius = 4.0,
          .freedom = Freedom::Rotation,
          .iterations = options.pose_iterations};
}

/// Cells of the picture that show a point of the panorama already.
std::vector<bool> occupied_cells(const geometry::Camera& camera, const MapView& panorama,
                                 const geometry::Pose& camera_from_world) {
  const int columns = camera.width() / kCell + 1;
  std::vector<bool> occupied(static_cast<std::size_t>(columns * (camera.height() / kCell + 1)));
  for (const MapView::Point& point : panorama.points) {
    const auto pixel = camera.project(camera_from_world * point.position);
    if (!pixel || !camera.contains(*pixel)) continue;
    occupied[static_cast<std::size_t>(static_cast<int>(pixel->y()) / kCell * columns +
                                      static_cast<int>(pixel->x()) / kCell)] = true;
  }
  return occupied;
}

}  // namespace

TurnFollower::TurnFollower(const geometry::Camera& camera, const config::Tracking& options)
    : camera_(camera), options_(options), localiser_(camera, passes(options)) {}

void TurnFollower::start(const std::shared_ptr<const Pyramid>& picture,
                         const Eigen::Quaterniond& camera_from_world) {
  stop();
  extend(picture, camera_from_world);
}

void TurnFollower::stop() {
  panorama_ = {};
  small_.clear();
}

void TurnFollower::extend(const std::shared_ptr<const Pyramid>& picture,
                          const Eigen::Quaterniond& camera_from_world) {
  const geometry::Pose pose(camera_from_world, Eigen::Vector3d::Zero());
  std::vector<bool> occupied = occupied_cells(camera_, panorama_, pose);
  const int columns = camera_.width() / kCell + 1;
  const auto keyframe = static_cast<KeyframeId>(panorama_.keyframes.size());
  int added = 0;
  for (const Corner& corner : detect_corners(*picture, options_.fast_threshold, kCorners)) {
    const Eigen::Vector2d pixel = from_level(corner.pixel, corner.level);
    const auto ray = camera_.unproject(pixel);
    if (!ray) continue;
    const auto cell = static_cast<std::size_t>(static_cast<int>(pixel.y()) / kCell * columns +
                                               static_cast<int>(pixel.x()) / kCell);
    if (occupied[cell]) continue;
    occupied[cell] = true;
    panorama_.points.push_back({static_cast<PointId>(panorama_.points.size()),
                                pose.inverse() * ray->homogeneous().normalized(),
                                static_cast<std::uint32_t>(panorama_.sightings.size()), 1});
    panorama_.sightings.push_back({keyframe, pixel, corner.level});
    ++added;
  }
  panorama_.keyframes.push_back({pose.inverse(), pose, picture, 1.0, added});
  small_.emplace_back(*picture);
}

std::optional<Eigen::Quaterniond> TurnFollower::follow(
    const std::shared_ptr<const Pyramid>& picture, const Eigen::Quaterniond& predicted) {
  const Localisation* found =
      localiser_.localise(panorama_, *picture, geometry::Pose(predicted, Eigen::Vector3d::Zero()));
  if (!found || found->inliers < kMinInliers || found->found_share() < kMinShare) {
    return std::nullopt;
  }
  const Eigen::Quaterniond turned = found->pose.camera_from_world.rotation;
  // Of all its pictures, not of the last: who turns to and fro for an hour adds none.
  const bool is_new = std::ranges::all_of(panorama_.keyframes, [&](const auto& keyframe) {
    return keyframe.camera_from_world.rotation.angularDistance(turned) > kStep;
  });
  if (is_new) extend(picture, turned);
  return turned;
}

std::optional<Eigen::Quaterniond> TurnFollower::find(const std::shared_ptr<const Pyramid>& picture,
                                                     const SmallImage& small) {
  double best = std::numeric_limits<double>::infinity();
  Eigen::Quaterniond predicted = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < small_.size(); ++i) {
    const RotationPrior prior = estimate_rotation(camera_, small_[i], small);
    if (prior.residual >= best) continue;
    best = prior.residual;
    predicted = prior.current_from_last * panorama_.keyframes[i].camera_from_world.rotation;
  }
  if (!(best < small.contrast())) return std::nullopt;  // like none of them
  return follow(picture, predicted);
}

}  // namespace lumibox::tracking
