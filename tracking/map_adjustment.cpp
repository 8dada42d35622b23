#include "tracking/map_adjustment.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tracking/bundle_adjustment.h"
#include "tracking/covisibility.h"

namespace lumibox::tracking {
namespace {

constexpr int kFixedViews = 10;   // that see most of the points; more add time, not accuracy
constexpr double kOutlier = 3.5;  // sigmas; 0.2 % of Gaussian errors in 2D are larger

struct MapProblem {
  BundleProblem bundle;
  std::vector<KeyframeId> keyframes;  // of bundle.views
  std::vector<PointId> points;        // of bundle.points
};

/// Keyframes outside `free` that see most of its points.
std::set<KeyframeId> choose_fixed(const Map& map, const std::set<KeyframeId>& free,
                                  const std::set<PointId>& points) {
  std::vector<std::pair<int, KeyframeId>> shared(map.keyframes().size());
  for (std::size_t i = 0; i < shared.size(); ++i) shared[i] = {0, static_cast<KeyframeId>(i)};
  for (const PointId id : points) {
    for (const Sighting& s : map.point(id).sightings) {
      if (!free.contains(s.keyframe)) --shared[static_cast<std::size_t>(s.keyframe)].first;
    }
  }
  std::sort(shared.begin(), shared.end());
  std::set<KeyframeId> fixed;
  for (const auto& [negative_count, id] : shared) {
    if (negative_count == 0 || fixed.size() == kFixedViews) break;
    fixed.insert(id);
  }
  return fixed;
}

/// All points seen by `free`, and their sightings in `free` and in the fixed views.
MapProblem make_problem(const geometry::Camera& camera, const Map& map,
                        const std::set<KeyframeId>& free) {
  MapProblem problem;
  std::map<KeyframeId, int> view_of;
  const auto add_view = [&](KeyframeId id) {
    const auto [entry, is_new] = view_of.emplace(id, static_cast<int>(problem.keyframes.size()));
    if (is_new) {
      problem.keyframes.push_back(id);
      problem.bundle.views.push_back(
          {map.keyframe(id).world_from_camera.inverse(), !free.contains(id)});
    }
    return entry->second;
  };
  std::set<PointId> points;
  for (const KeyframeId id : free) {
    points.insert(map.keyframe(id).points.begin(), map.keyframe(id).points.end());
  }
  const std::set<KeyframeId> fixed = choose_fixed(map, free, points);
  for (const PointId id : points) {
    const int index = static_cast<int>(problem.points.size());
    problem.points.push_back(id);
    problem.bundle.points.push_back(map.point(id).position);
    for (const Sighting& s : map.point(id).sightings) {
      if (!free.contains(s.keyframe) && !fixed.contains(s.keyframe)) continue;
      problem.bundle.observations.push_back(
          {add_view(s.keyframe), index, s.pixel, static_cast<double>(1 << s.level),
           geometry::row_from_frame(camera, map.keyframe(s.keyframe).readout_twist, s.pixel.y()),
           0.0});
    }
  }
  return problem;
}

void apply(Map& map, const MapProblem& problem) {
  const BundleProblem& bundle = problem.bundle;
  for (std::size_t i = 0; i < problem.keyframes.size(); ++i) {
    if (bundle.views[i].fixed) continue;
    map.keyframe(problem.keyframes[i]).world_from_camera =
        bundle.views[i].camera_from_world.inverse();
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    map.point(problem.points[i]).position = bundle.points[i];
  }
}

void remove_outliers(Map& map, const MapProblem& problem) {
  const BundleProblem& bundle = problem.bundle;
  for (const auto& o : bundle.observations) {
    if (o.error_in_sigma < kOutlier) continue;
    map.remove_sighting(problem.points[static_cast<std::size_t>(o.point)],
                        problem.keyframes[static_cast<std::size_t>(o.view)]);
  }
  for (const PointId id : problem.points) {
    if (map.point(id).sightings.size() < 2) map.remove_point(id);
  }
}

/// False if it was interrupted.
bool adjust_keyframes(const geometry::Camera& camera, Map& map, std::set<KeyframeId> free,
                      int iterations, const std::function<bool()>& interrupted) {
  free.erase(0);  // the world's origin does not move
  if (free.empty()) return true;
  MapProblem problem = make_problem(camera, map, free);
  bool complete = true;
  const auto enough = [&] {
    if (interrupted && interrupted()) complete = false;
    return !complete;
  };
  if (adjust(camera, problem.bundle, iterations, enough)) {
    apply(map, problem);
    if (complete) remove_outliers(map, problem);
  }
  map.update_depths();
  return complete;
}

}  // namespace

void adjust_locally(const geometry::Camera& camera, const config::Tracking& options, Map& map,
                    KeyframeId id) {
  const std::vector<KeyframeId> neighbours =
      covisible_keyframes(map, id, options.local_keyframes - 1);
  std::set<KeyframeId> free(neighbours.begin(), neighbours.end());
  free.insert(id);
  adjust_keyframes(camera, map, free, options.local_iterations, {});
}

bool adjust_globally(const geometry::Camera& camera, const config::Tracking& options, Map& map,
                     const std::function<bool()>& interrupted) {
  std::set<KeyframeId> free;
  for (KeyframeId id = 0; id < static_cast<KeyframeId>(map.keyframes().size()); ++id) {
    free.insert(id);
  }
  return adjust_keyframes(camera, map, free, options.global_iterations, interrupted);
}

}  // namespace lumibox::tracking
