#include "lightfield/scene_points.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "lightfield/epipolar_matching.h"
#include "lightfield/features.h"
#include "lightfield/lonely_points.h"
#include "lightfield/neighbours.h"
#include "lightfield/track_triangulation.h"

namespace lumibox::lightfield {
namespace {

constexpr std::size_t kFeaturesPerPicture = 4000;
constexpr std::size_t kFeaturesInAll = 600'000;  // about 110 MB

/// Which features of all pictures are thought to be one (disjoint sets with path halving).
class Tracks {
 public:
  explicit Tracks(const std::vector<Features>& features) : first_{0} {
    for (const Features& f : features) first_.push_back(first_.back() + f.pixels.size());
    parent_.resize(first_.back());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void join(std::size_t view_a, std::size_t a, std::size_t view_b, std::size_t b) {
    const std::size_t root_a = root(first_[view_a] + a);
    const std::size_t root_b = root(first_[view_b] + b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

  /// The tracks in order of their first feature; a feature without a match is one by itself.
  std::vector<std::vector<Observation>> collect(const std::vector<Features>& features) {
    std::vector<std::vector<Observation>> tracks(parent_.size());
    for (std::size_t view = 0; view < features.size(); ++view) {
      for (std::size_t i = 0; i < features[view].pixels.size(); ++i) {
        tracks[root(first_[view] + i)].push_back(
            {view, features[view].pixels[i], features[view].bearings[i]});
      }
    }
    return tracks;
  }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::vector<std::size_t> first_;   ///< of each view, in parent_
  std::vector<std::size_t> parent_;  ///< itself for a root, else one before it
};

/// One direction for all pictures: up, of cameras that are held upright.
Eigen::Vector3d common_up(const std::vector<Perspective>& perspectives) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Perspective& perspective : perspectives) {
    sum -= perspective.world_from_camera.rotation * Eigen::Vector3d::UnitY();
  }
  return sum.norm() > 1e-3 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::UnitY();
}

std::vector<View> make_views(const std::vector<Perspective>& perspectives,
                             const std::vector<Features>& features) {
  std::vector<View> views;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    views.push_back({perspectives[i].world_from_camera.inverse(), perspectives[i].camera.get(),
                     features[i].tolerance_px});
  }
  return views;
}

}  // namespace

std::vector<Eigen::Vector3d> find_scene_points(const std::vector<Perspective>& perspectives,
                                               const ProgressReport& progress) {
  const auto pairs = neighbouring_pairs(perspectives);
  if (pairs.empty()) return {};
  const auto total = static_cast<std::int64_t>(perspectives.size() + pairs.size());
  std::int64_t done = 0;
  const auto advance = [&] {
    if (progress) progress(++done, total);
  };

  const std::size_t limit = std::min(kFeaturesPerPicture, kFeaturesInAll / perspectives.size());
  const Eigen::Vector3d up = common_up(perspectives);
  std::vector<Features> features;
  for (const Perspective& perspective : perspectives) {
    features.push_back(find_features(perspective, up, limit));
    advance();
  }
  Tracks tracks(features);
  for (const auto& [a, b] : pairs) {
    for (const auto& [in_a, in_b] :
         match_along_epipolar_lines(features[a], perspectives[a].world_from_camera, features[b],
                                    perspectives[b].world_from_camera)) {
      tracks.join(a, in_a, b, in_b);
    }
    advance();
  }
  const std::vector<View> views = make_views(perspectives, features);
  std::vector<TrackPoint> found;
  for (std::vector<Observation>& track : tracks.collect(features)) {
    for (TrackPoint& point : triangulate_track(views, std::move(track))) {
      found.push_back(std::move(point));
    }
  }
  std::vector<Eigen::Vector3d> points;
  for (const TrackPoint& point : without_lonely_points(views, found)) {
    points.push_back(point.position);
  }
  return points;
}

}  // namespace lumibox::lightfield
