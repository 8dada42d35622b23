#include "lightfield/light_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightfield/coverage.h"
#include "support/photo.h"

namespace lumibox::lightfield {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;

Perspective at(const Vector3d& center) {
  Perspective perspective;
  perspective.world_from_camera.translation = center;
  return perspective;
}

LightField around_origin(const std::vector<Vector3d>& centers) {
  LightField light_field;
  light_field.set_subject({Vector3d::Zero(), 1.0});
  for (const Vector3d& center : centers) light_field.add(at(center));
  return light_field;
}

std::vector<int> ids(const LightField& light_field) {
  std::vector<int> ids;
  for (const Perspective& perspective : light_field.perspectives()) ids.push_back(perspective.id);
  return ids;
}

/// Coordinates on a coarse grid, so that coincident, collinear and antipodal centres occur.
Vector3d any_center() {
  const auto coordinate = [] { return 0.5 * *rc::gen::inRange(-3, 4); };
  const double x = coordinate();
  const double y = coordinate();
  return {x, y, coordinate()};
}

std::vector<Vector3d> any_centers() {
  std::vector<Vector3d> centers(static_cast<std::size_t>(*rc::gen::inRange(0, 30)));
  for (Vector3d& center : centers) center = any_center();
  return centers;
}

TEST(Gate, RefusesEverythingWithoutSubject) {
  LightField light_field;
  EXPECT_FALSE(light_field.accepts({1.0, 0.0, 0.0}, 0.0));
  light_field.set_subject({Vector3d::Zero(), 1.0});
  EXPECT_TRUE(light_field.accepts({1.0, 0.0, 0.0}, 0.0));
}

TEST(Gate, ThresholdItselfIsNotEnough) {
  const LightField light_field = around_origin({{1.0, 0.0, 0.0}});
  const double quarter = std::numbers::pi / 2.0;
  EXPECT_FALSE(light_field.accepts({0.0, 2.0, 0.0}, quarter + 1e-12));
  EXPECT_TRUE(light_field.accepts({0.0, 2.0, 0.0}, quarter - 1e-12));
}

TEST(Gate, OneDirectionAtAnotherDistanceIsNotNew) {
  const LightField light_field = around_origin({{1.0, 2.0, 3.0}});
  EXPECT_FALSE(light_field.accepts({2.0, 4.0, 6.0}, 1e-9));
}

TEST(Gate, AntipodeIsAsNewAsCanBe) {
  const LightField light_field = around_origin({{1.0, 2.0, 3.0}});
  EXPECT_TRUE(light_field.accepts({-2.0, -4.0, -6.0}, std::numbers::pi - 1e-9));
  EXPECT_FALSE(light_field.accepts({-2.0, -4.0, -6.0}, std::numbers::pi));
}

TEST(Gate, CameraAtSubjectIsNeverAccepted) {
  EXPECT_FALSE(around_origin({}).accepts(Vector3d::Zero(), 0.0));
  EXPECT_FALSE(around_origin({{1.0, 0.0, 0.0}}).accepts(Vector3d::Zero(), -1.0));
}

TEST(Gate, RecordedCentreAtSubjectCoversNothing) {
  EXPECT_TRUE(around_origin({Vector3d::Zero()}).accepts({1.0, 0.0, 0.0}, 0.1));
}

TEST(Gate, RefusesWhatIsNotFinite) {
  EXPECT_FALSE(around_origin({}).accepts({NAN, 0.0, 0.0}, 0.1));
  EXPECT_FALSE(around_origin({{1.0, 0.0, 0.0}}).accepts({0.0, 1.0, 0.0}, NAN));
}

TEST(Gate, FourHundredAndTwentyAtOnePoint) {
  const LightField light_field =
      around_origin(std::vector<Vector3d>(420, Vector3d(0.3, 0.1, -2.0)));
  EXPECT_FALSE(light_field.accepts({0.3, 0.1, -2.0}, 0.0));
  EXPECT_TRUE(light_field.accepts({0.3, 0.1, 2.0}, 0.5));
  EXPECT_EQ(light_field.nearest({1.0, 1.0, 1.0}), 0);
}

RC_GTEST_PROP(Gate, AgreesWithEveryAngleByTheCosineRule, ()) {
  const std::vector<Vector3d> centers = any_centers();
  const Vector3d candidate = any_center();
  const double threshold = *rc::gen::inRange(1, 1800) * 1e-3 + 1e-7;
  bool expected = candidate.norm() > 0.0;
  for (const Vector3d& center : centers) {
    if (center.norm() == 0.0 || candidate.norm() == 0.0) continue;
    const double a = candidate.norm();
    const double b = center.norm();
    const double c2 = (candidate - center).squaredNorm();
    const double cosine = std::clamp((a * a + b * b - c2) / (2.0 * a * b), -1.0, 1.0);
    expected = expected && std::acos(cosine) > threshold;
  }
  RC_ASSERT(around_origin(centers).accepts(candidate, threshold) == expected);
}

RC_GTEST_PROP(Gate, OrderOfRecordingDoesNotMatter, ()) {
  std::vector<Vector3d> centers = any_centers();
  const Vector3d candidate = any_center();
  const double threshold = *rc::gen::inRange(0, 3000) * 1e-3;
  const bool accepted = around_origin(centers).accepts(candidate, threshold);
  std::reverse(centers.begin(), centers.end());
  RC_ASSERT(around_origin(centers).accepts(candidate, threshold) == accepted);
}

RC_GTEST_PROP(Gate, AcceptedSetKeepsTheThresholdPairwise, ()) {
  const double threshold = *rc::gen::inRange(1, 1500) * 1e-3;
  LightField light_field = around_origin({});
  for (const Vector3d& center : any_centers()) {
    if (light_field.accepts(center, threshold)) light_field.add(at(center));
  }
  const auto& kept = light_field.perspectives();
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      RC_ASSERT(angle_at_subject(kept[i].center(), Vector3d::Zero(), kept[j].center()) > threshold);
    }
  }
}

TEST(Nearest, IsByAngleThenDistance) {
  const LightField light_field =
      around_origin({{1.0, 0.0, 0.0}, {9.0, 0.1, 0.0}, {3.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}});
  EXPECT_EQ(light_field.nearest({2.8, 0.0, 0.0}), 2);
  EXPECT_EQ(light_field.nearest({1.0, 0.012, 0.0}), 1);
}

TEST(Nearest, WithoutSubjectIsByDistance) {
  LightField light_field;
  EXPECT_EQ(light_field.nearest(Vector3d::Zero()), std::nullopt);
  light_field.add(at({1.0, 0.0, 0.0}));
  light_field.add(at({0.1, 0.5, 0.0}));
  EXPECT_EQ(light_field.nearest(Vector3d::Zero()), 1);
}

TEST(Wipe, UndoBringsBackInReverseOrderAndInPlace) {
  LightField light_field = around_origin(std::vector<Vector3d>(5, Vector3d::UnitX()));
  light_field.wipe(1);
  light_field.wipe(3);
  EXPECT_EQ(light_field.wipe(3), std::nullopt);
  light_field.add(at(Vector3d::UnitY()));
  EXPECT_THAT(ids(light_field), ElementsAre(0, 2, 4, 5));
  EXPECT_EQ(light_field.undo_wipe()->id, 3);
  EXPECT_EQ(light_field.undo_wipe()->id, 1);
  EXPECT_EQ(light_field.undo_wipe(), std::nullopt);
  EXPECT_THAT(ids(light_field), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Wipe, FreesTheDirection) {
  LightField light_field = around_origin({Vector3d::UnitX()});
  light_field.wipe(0);
  EXPECT_TRUE(light_field.accepts(Vector3d::UnitX(), 0.1));
  light_field.undo_wipe();
  EXPECT_FALSE(light_field.accepts(Vector3d::UnitX(), 0.1));
}

TEST(Wipe, CorrectionReachesWhatIsWiped) {
  LightField light_field = around_origin({Vector3d::UnitX()});
  light_field.wipe(0);
  EXPECT_TRUE(light_field.set_pose(0, at(Vector3d::UnitY()).world_from_camera));
  EXPECT_EQ(light_field.undo_wipe()->center(), Vector3d::UnitY());
  EXPECT_FALSE(light_field.set_pose(1, {}));
}

RC_GTEST_PROP(Wipe, AnySequenceMatchesASetAndAStack, ()) {
  LightField light_field = around_origin({});
  std::vector<int> present;
  std::vector<int> stack;
  int next = 0;
  for (const int action : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 30))) {
    const std::uint64_t before = light_field.revision();
    if (action < 10) {
      RC_ASSERT(light_field.add(at(Vector3d::UnitX())) == next);
      present.push_back(next++);
    } else if (action < 22) {
      const int id = action - 10;
      const auto found = std::find(present.begin(), present.end(), id);
      RC_ASSERT(light_field.wipe(id).has_value() == (found != present.end()));
      if (found == present.end()) continue;
      present.erase(found);
      stack.push_back(id);
    } else {
      const auto restored = light_field.undo_wipe();
      RC_ASSERT(restored.has_value() == !stack.empty());
      if (stack.empty()) continue;
      RC_ASSERT(restored->id == stack.back());
      present.push_back(stack.back());
      stack.pop_back();
      std::sort(present.begin(), present.end());
    }
    RC_ASSERT(light_field.revision() > before);
    RC_ASSERT(ids(light_field) == present);
  }
}

TEST(LightField, StoredIdsAreKeptAndNotReused) {
  std::vector<Perspective> stored{at(Vector3d::UnitX()), at(Vector3d::UnitY())};
  stored[0].id = 7;
  stored[1].id = 2;
  LightField light_field(stored, std::nullopt);
  EXPECT_THAT(ids(light_field), ElementsAre(2, 7));
  EXPECT_EQ(light_field.add(at(Vector3d::UnitZ())), 8);
}

TEST(LightField, SaysHowManyPicturesAreLostAndWhyTheFirstIs) {
  LightField light_field;
  for (int i = 0; i < 3; ++i) {
    Perspective perspective = at(Vector3d::UnitX());
    perspective.photo = testing::photo_of(hal::Image(16, 12, 3));
    perspective.photo->stored_in("/nowhere/" + std::to_string(i) + ".jpg");
    light_field.add(perspective);
  }
  light_field.add(at(Vector3d::UnitY()));  // has none that could be lost
  EXPECT_EQ(light_field.lost_pictures(), std::nullopt) << "nobody has looked";
  for (const std::size_t i : {2U, 1U}) light_field.perspectives()[i].photo->rgb();
  const std::string said = light_field.lost_pictures().value_or("");
  EXPECT_THAT(said,
              ::testing::StartsWith("2 of 4 pictures are lost: /nowhere/1.jpg: no such file"));
  EXPECT_FALSE(light_field.perspectives()[2].can_be_shown());
}

RC_GTEST_PROP(Coverage, DotLiesOnTheSphereTowardsTheCamera, ()) {
  const Sphere sphere{any_center(), 0.25 * *rc::gen::inRange(1, 9)};
  const Vector3d center = any_center();
  const auto dot = dot_on_sphere(sphere, center);
  RC_ASSERT(dot.has_value() == (center != sphere.center));
  if (!dot) return;
  RC_ASSERT(std::abs((*dot - sphere.center).norm() - sphere.radius) < 1e-12);
  RC_ASSERT(angle_at_subject(*dot, sphere.center, center) < 1e-12);
}

}  // namespace
}  // namespace lumibox::lightfield
