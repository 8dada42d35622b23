#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/pinhole.h"
#include "tracking/loop_closing.h"
#include "tracking/loop_detector.h"
#include "tracking/map_adjustment.h"
#include "tracking/orbit_world.h"
#include "tracking/textured_world.h"
#include "tracking/tracker.h"

namespace lumibox::tracking {
namespace {

constexpr double kStep = 7.0 * std::numbers::pi / 180.0;
constexpr int kAround = 53;  // keyframes of 371 degrees

config::Tracking options() {
  config::Tracking o;
  o.pyramid_levels = 3;
  return o;
}

/// Turn, slide and growth per keyframe: 9 degrees, a sixth of the orbit's radius and a fifth of the
/// scale in all. No search around a prediction would find the beginning again.
geometry::Vector7d drift() {
  geometry::Vector7d d;
  d << 0.004, 0.002, 0.0, 0.001, 0.003, 0.0, 0.0035;
  return d;
}

const testing::OrbitMap& drifted_orbit() {
  static const testing::OrbitMap orbit(testing::small_camera(), testing::Can(1), kAround, kStep,
                                       drift());
  return orbit;
}

/// Root mean square distance of the keyframes from the truth, aligned, as a share of the orbit's
/// diameter.
double error_of(const Map& map, const std::vector<geometry::Pose>& truth) {
  Eigen::Matrix3Xd estimated(3, truth.size());
  Eigen::Matrix3Xd wanted(3, truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    estimated.col(static_cast<Eigen::Index>(i)) = map.keyframes()[i].world_from_camera.translation;
    wanted.col(static_cast<Eigen::Index>(i)) = truth[i].translation;
  }
  const geometry::Similarity aligned = geometry::align_umeyama(estimated, wanted);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < wanted.cols(); ++i) {
    sum += (aligned * Eigen::Vector3d(estimated.col(i)) - wanted.col(i)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size())) / 4.0;
}

TEST(LoopDetector, FindsTheBeginningAgainWhateverHasDrifted) {
  const auto& orbit = drifted_orbit();
  LoopDetector detector(testing::small_camera(), options());
  const CovisibilityGraph graph(orbit.map, kConnected);
  const auto loop = detector.find(orbit.map, graph, kAround - 1, 3);
  ASSERT_TRUE(loop);
  EXPECT_LE(loop->then, 6);
  EXPECT_EQ(loop->ties.front().keyframe, kAround - 1);
  for (const Loop::Tie& tie : loop->ties) {
    // 1 % of the distance: the older part has drifted over six keyframes itself.
    const auto at = static_cast<std::size_t>(tie.keyframe);
    const double off =
        (tie.world_from_keyframe.rigid.translation - orbit.truth[at].translation).norm();
    EXPECT_LT(off, 0.05) << tie.keyframe;
    EXPECT_NEAR(tie.world_from_keyframe.scale * orbit.drifted.back().scale, 1.0, 0.03);
    EXPECT_GE(tie.sightings.size(), 40U);
  }
}

TEST(LoopDetector, HalfAnOrbitIsNoLoop) {
  const auto& orbit = drifted_orbit();
  LoopDetector detector(testing::small_camera(), options());
  const CovisibilityGraph graph(orbit.map, kConnected);
  for (KeyframeId id = 20; id < 40; ++id)
    EXPECT_FALSE(detector.find(orbit.map, graph, id, 1)) << id;
}

// Nothing in the pictures tells its back from its front: the way between the two does.
TEST(LoopDetector, ACanDoesNotCloseOntoItsBack) {
  const testing::OrbitMap orbit(testing::small_camera(), testing::Can(2), 30, kStep,
                                geometry::Vector7d::Zero());
  LoopDetector detector(testing::small_camera(), options());
  const CovisibilityGraph graph(orbit.map, kConnected);
  for (KeyframeId id = 15; id < 30; ++id)
    EXPECT_FALSE(detector.find(orbit.map, graph, id, 1)) << id;
}

TEST(LoopDetector, WhatTrackingCannotHaveDriftedIsNotPlausible) {
  const Way around{6.0, 6.0};
  EXPECT_TRUE(is_plausible({0.5, 0.3, 1.3}, around));
  EXPECT_FALSE(is_plausible({2.0, 0.3, 1.3}, around));
  EXPECT_FALSE(is_plausible({0.5, 2.0, 1.3}, around));
  EXPECT_FALSE(is_plausible({0.5, 0.3, 2.5}, around));
  EXPECT_FALSE(is_plausible({0.5, 0.3, 0.3}, around));
  EXPECT_TRUE(is_plausible({0.5, 0.05, 1.0}, {6.0, 0.0})) << "a straight way turns a little, too";
  const Way half{std::numbers::pi, std::numbers::pi};
  EXPECT_FALSE(is_plausible({2.0, std::numbers::pi, 1.0}, half)) << "the back of a can";
}

// The drift is 15 % of the diameter. Sightings are exact but for those that tie the ends, which are
// aligned patches: what is left, 0.0003, is their error.
TEST(LoopClosing, BothEndsOfADriftedOrbitMeet) {
  const auto& orbit = drifted_orbit();
  const geometry::Camera camera = testing::small_camera();
  Map map = orbit.map;
  ASSERT_GT(error_of(map, orbit.truth), 0.03);
  LoopDetector detector(camera, options());
  const CovisibilityGraph graph(map, kConnected);
  const auto loop = detector.find(map, graph, kAround - 1, 3);
  ASSERT_TRUE(loop);
  const std::size_t points = map.points().size();
  ASSERT_TRUE(close_loop(map, graph, *loop));
  EXPECT_LT(error_of(map, orbit.truth), 0.01) << "before any adjustment";
  EXPECT_LT(map.points().size(), points) << "points known twice become one";
  EXPECT_NEAR(map.keyframe(kAround - 1).scale * orbit.drifted.back().scale, 1.0, 0.05);
  EXPECT_EQ(map.keyframe(0).world_from_camera.translation, orbit.truth[0].translation);
  for (int i = 0; i < 2; ++i) adjust_globally(camera, options(), map);
  EXPECT_LT(error_of(map, orbit.truth), 0.0005);
}

TEST(AdjustGlobally, WhatIsInterruptedIsGainedAndLosesNoSighting) {
  const auto& orbit = drifted_orbit();
  Map map = orbit.map;
  for (auto& keyframe : map.keyframes()) keyframe.world_from_camera.translation.x() += 0.02;
  const auto sightings = [](const Map& m) {
    std::size_t sum = 0;
    for (const auto& [id, point] : m.points()) sum += point.sightings.size();
    return sum;
  };
  Map whole = map;
  int asked = 0;
  EXPECT_FALSE(
      adjust_globally(testing::small_camera(), options(), map, [&] { return ++asked == 2; }));
  EXPECT_EQ(asked, 2) << "after each step";
  EXPECT_EQ(sightings(map), sightings(orbit.map));
  EXPECT_NE(map.keyframe(1).world_from_camera.translation,
            whole.keyframe(1).world_from_camera.translation);
  EXPECT_TRUE(adjust_globally(testing::small_camera(), options(), whole, [] { return false; }));
}

TEST(LoopClosing, AMapMeetsItselfOnlyAfterAWayAround) {
  const auto& orbit = drifted_orbit();
  Map map = orbit.map;
  const CovisibilityGraph before(map, kConnected);
  for (KeyframeId id = 1; id < kAround; ++id) EXPECT_FALSE(has_met_itself(map, before, id)) << id;
  const std::vector<PointId> first = map.keyframe(1).points;
  for (const PointId p : first) map.add_sighting(p, {kAround - 1, Eigen::Vector2d::Zero(), 0});
  EXPECT_TRUE(has_met_itself(map, CovisibilityGraph(map, kConnected), kAround - 1));
}

TEST(LoopClosing, PointsAtOnePlaceBecomeOneAndOthersDoNot) {
  Map map;
  const auto pyramid = std::make_shared<const Pyramid>(hal::Image(32, 32, 1), 2);
  for (int i = 0; i < 3; ++i) map.add_keyframe({}, pyramid);
  const auto add = [&](double depth, double x, int level, KeyframeId other) {
    const PointId id = map.add_point({0.0, 0.0, depth});
    map.add_sighting(id, {0, {x, 10.0}, level});
    map.add_sighting(id, {other, {x, 10.0}, level});
    return id;
  };
  const PointId kept = add(2.0, 10.0, 0, 1);
  const PointId same = add(2.05, 10.2, 0, 2);
  const PointId behind = add(3.0, 10.0, 0, 2);
  const PointId aside = add(2.0, 10.5, 0, 2);
  const PointId coarser = add(2.0, 10.0, 1, 2);
  EXPECT_EQ(merge_duplicates(map, 0), 1);
  EXPECT_FALSE(map.has_point(same));
  EXPECT_EQ(map.point(kept).sightings.size(), 3U);
  for (const PointId id : {behind, aside, coarser}) EXPECT_TRUE(map.has_point(id));
}

/// An orbit tracked with the focal length off by `focal_error`, which bends the walk: an assumed
/// field of view does that.
struct TrackedOrbit {
  explicit TrackedOrbit(double focal_error, int frames)
      : tracker(lumibox::testing::pinhole(320, 240, 270.0 * (1.0 + focal_error)), options(),
                Mapping::Lockstep, 1) {
    constexpr double kFrameStep = 2.0 * std::numbers::pi / kFramesAround;
    const testing::Can can(1);
    for (int i = 0; i < frames; ++i) {
      truth.push_back(testing::on_orbit(kFrameStep * i));
      tracked.push_back(
          tracker.track(can.render(testing::small_camera(), truth.back()), i, 33'333'333LL * i));
    }
  }

  geometry::Pose corrected(std::size_t i) const {
    return tracker.world_from_keyframe(tracked[i].keyframe).value() *
           tracked[i].keyframe_from_camera;
  }

  /// Distance between the last frame and the one that was taken at the same place an orbit
  /// earlier, as a share of the walk's extent.
  double gap() const {
    const geometry::Pose last = corrected(tracked.size() - 1);
    double extent = 0.0;
    for (std::size_t i = 0; i < tracked.size(); ++i) {
      if (!tracked[i].world_from_camera) continue;
      extent = std::max(extent, (corrected(i).translation - last.translation).norm());
    }
    const geometry::Pose first = corrected(tracked.size() - 1 - kFramesAround);
    return (first.translation - last.translation).norm() / extent;
  }

  static constexpr std::size_t kFramesAround = 300;
  Tracker tracker;
  std::vector<geometry::Pose> truth;
  std::vector<TrackedFrame> tracked;
};

// The focal length is off by 1 %, the walk bent by as much; the beginning still is within the
// search. 0.4 % of the extent: three quarters of a pixel in these small pictures.
TEST(LoopClosing, AnOrbitThatComesBackToItsOwnPointsIsALoop) {
  TrackedOrbit orbit(0.01, 306);
  EXPECT_EQ(orbit.tracker.statistics().loops_closed, 1);
  orbit.tracker.finish();
  EXPECT_EQ(orbit.tracker.statistics().loops_closed, 1) << "it is the same loop at the end";
  EXPECT_LT(orbit.gap(), 0.004);
}

}  // namespace
}  // namespace lumibox::tracking
