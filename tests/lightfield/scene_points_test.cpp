#include "lightfield/scene_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/rotation.h"
#include "lightfield/epipolar_matching.h"
#include "lightfield/features.h"
#include "lightfield/neighbours.h"
#include "support/photo.h"
#include "support/pinhole.h"

namespace lumibox::lightfield {
namespace {

/// Brightness in [0, 1] of a plane's paint at a place on it.
using Paint = std::function<double(double x, double y)>;

/// A random number in [0, 1] for a cell, always the same.
double cell_value(int x, int y) {
  auto h =
      static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U;
  h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12U)) * 0x297A2D39U;
  return static_cast<double>((h ^ (h >> 15U)) & 0xFFFFU) / 65535.0;
}

/// Smooth random paint that nowhere repeats, with spots of about `size`.
double speckle(double x, double y, double size) {
  const double u = x / size;
  const double v = y / size;
  const int i = static_cast<int>(std::floor(u));
  const int j = static_cast<int>(std::floor(v));
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double a = smooth(u - i);
  const double b = smooth(v - j);
  return (1.0 - b) * ((1.0 - a) * cell_value(i, j) + a * cell_value(i + 1, j)) +
         b * ((1.0 - a) * cell_value(i, j + 1) + a * cell_value(i + 1, j + 1));
}

double spots(double x, double y) {
  return 0.6 * speckle(x, y, 0.15) + 0.4 * speckle(x + 7.0, y, 0.06);
}

/// A wall at z = 4 and a card before it at z = 2.5, half a unit to every side of the axis.
constexpr double kWall = 4.0;
constexpr double kCard = 2.5;
bool on_card(const Eigen::Vector2d& place) {
  return place.cwiseAbs().maxCoeff() < 0.5;
}

struct Room {
  Paint wall = spots;
  Paint card = [](double x, double y) { return spots(x + 30.0, y); };

  double brightness(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    const auto meet = [&](double z) -> Eigen::Vector2d {
      return (from + (z - from.z()) / direction.z() * direction).head<2>();
    };
    const Eigen::Vector2d near = meet(kCard);
    if (card && on_card(near)) return card(near.x(), near.y());
    const Eigen::Vector2d far = meet(kWall);
    return wall(far.x(), far.y());
  }
};

geometry::Camera camera_with(double k1) {
  config::CameraProfile profile = testing::pinhole(240, 180, 210.0).profile();
  profile.k1 = k1;
  return geometry::Camera(profile);
}

Perspective photograph(const Room& room, const geometry::Pose& world_from_camera, double k1 = 0.0) {
  Perspective perspective;
  perspective.world_from_camera = world_from_camera;
  perspective.camera = std::make_shared<const geometry::Camera>(camera_with(k1));
  hal::Image gray(240, 180, 1);
  for (int y = 0; y < gray.height(); ++y) {
    for (int x = 0; x < gray.width(); ++x) {
      const Eigen::Vector3d bearing =
          perspective.camera->unproject(Eigen::Vector2d(x, y)).value().homogeneous();
      const double value =
          room.brightness(world_from_camera.translation, world_from_camera.rotation * bearing);
      *gray.at(x, y) = static_cast<std::uint8_t>(std::lround(20.0 + 215.0 * value));
    }
  }
  perspective.photo = testing::photo_of(hal::to_rgb(gray));
  return perspective;
}

/// A camera at (x, y, 0), turned a little towards the scene and by `roll` around its axis.
geometry::Pose hand_at(double x, double y, double roll = 0.0) {
  return {geometry::exp_so3({0.2 * y, -0.2 * x, 0.0}) * geometry::exp_so3({0.0, 0.0, roll}),
          {x, y, 0.0}};
}

std::vector<Perspective> six_photographs(const Room& room, double k1 = 0.0) {
  std::vector<Perspective> perspectives;
  for (int i = 0; i < 6; ++i) {
    perspectives.push_back(
        photograph(room, hand_at(-0.5 + 0.2 * i, i % 2 == 0 ? 0.1 : -0.1, 0.1 * i), k1));
  }
  return perspectives;
}

/// How many points lie on the wall, on the card and on neither.
struct Count {
  int wall = 0;
  int card = 0;
  int neither = 0;
};
Count count(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kTolerance = 0.05;  // of the distance
  Count count;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(point.z() / kWall - 1.0) < kTolerance) {
      ++count.wall;
    } else if (std::abs(point.z() / kCard - 1.0) < kTolerance && on_card(point.head<2>() * 0.96)) {
      ++count.card;
    } else {
      ++count.neither;
    }
  }
  return count;
}

TEST(ScenePoints, LieOnWhatThePicturesShow) {
  const Count found = count(find_scene_points(six_photographs(Room())));
  EXPECT_GT(found.wall, 150);
  EXPECT_GT(found.card, 60);
  EXPECT_LE(found.neither, 2);
}

TEST(ScenePoints, AreOfTheLensThatThePicturesHave) {
  const Count found = count(find_scene_points(six_photographs(Room(), -0.25)));
  EXPECT_GT(found.wall, 150);
  EXPECT_GT(found.card, 60);
  EXPECT_LE(found.neither, 2);
}

TEST(ScenePoints, AreTheSameEveryTime) {
  const std::vector<Perspective> perspectives = six_photographs(Room());
  const auto points = find_scene_points(perspectives);
  ASSERT_FALSE(points.empty());
  EXPECT_EQ(find_scene_points(perspectives), points);
}

TEST(ScenePoints, DoNotDependOnTheUnitOfLength) {
  std::vector<Perspective> perspectives = six_photographs(Room());
  const auto points = find_scene_points(perspectives);
  constexpr double kUnit = 1048576.0;
  for (Perspective& perspective : perspectives) perspective.world_from_camera.translation *= kUnit;
  const auto scaled = find_scene_points(perspectives);
  ASSERT_EQ(scaled.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((scaled[i] / kUnit - points[i]).norm(), 1e-6) << i;
  }
}

TEST(ScenePoints, AreNoneWhereNothingIsSeen) {
  Room bare{[](double, double) { return 0.5; }, nullptr};
  EXPECT_TRUE(find_scene_points(six_photographs(bare)).empty());
  EXPECT_TRUE(find_scene_points({}).empty());
  std::vector<Perspective> perspectives = six_photographs(Room());
  perspectives.resize(2);
  EXPECT_TRUE(find_scene_points(perspectives).empty());
}

TEST(ScenePoints, AreNoneWithoutParallax) {
  std::vector<Perspective> perspectives;
  for (const double x : {-0.5, 0.0, 0.5}) {
    perspectives.push_back(photograph(Room(), {hand_at(x, 0.0).rotation, Eigen::Vector3d::Zero()}));
  }
  EXPECT_TRUE(find_scene_points(perspectives).empty());
  for (std::size_t i = 0; i < 3; ++i) {
    perspectives[i].world_from_camera.translation.x() = 1e-4 * static_cast<double>(i);
  }
  EXPECT_TRUE(find_scene_points(perspectives).empty());
}

// Every post is like its neighbour, and with the cameras in a row and equally far apart a wrong
// depth explains all pictures as well as the right one.
TEST(ScenePoints, AreNotTakenFromAPatternThatRepeats) {
  constexpr double kPeriod = 0.2;
  const Room fence{[](double x, double y) {
                     const double across =
                         x + 0.0137;  // no pixel on a seam, where rounding decides
                     return speckle(across - kPeriod * std::floor(across / kPeriod), y, 0.07);
                   },
                   nullptr};
  std::vector<Perspective> perspectives;
  for (int i = 0; i < 6; ++i)
    perspectives.push_back(
        photograph(fence, {Eigen::Quaterniond::Identity(), {0.2 * i, 0.0, 0.0}}));
  const Count found = count(find_scene_points(perspectives));
  EXPECT_EQ(found.card + found.neither, 0);
}

TEST(ScenePoints, ReportHowFarTheWorkIs) {
  std::vector<std::int64_t> steps;
  std::int64_t last_total = 0;
  find_scene_points(six_photographs(Room()), [&](std::int64_t done, std::int64_t total) {
    steps.push_back(done);
    last_total = total;
  });
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.front(), 1);
  EXPECT_EQ(steps.back(), last_total);
  EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
}

TEST(EpipolarMatching, FindsTheSameInAPictureThatIsTurned) {
  const Perspective a = photograph(Room(), hand_at(-0.1, 0.0));
  for (const double roll : {0.0, 1.5, 3.0}) {
    const Perspective b = photograph(Room(), hand_at(0.1, 0.0, roll));
    const Features in_a = find_features(a, -Eigen::Vector3d::UnitY(), 1000);
    const Features in_b = find_features(b, -Eigen::Vector3d::UnitY(), 1000);
    const auto matches =
        match_along_epipolar_lines(in_a, a.world_from_camera, in_b, b.world_from_camera);
    EXPECT_GT(matches.size(), 100U) << roll;
    std::vector<std::size_t> seconds;
    for (const auto& [first, second] : matches) seconds.push_back(second);
    std::sort(seconds.begin(), seconds.end());
    EXPECT_EQ(std::adjacent_find(seconds.begin(), seconds.end()), seconds.end());
  }
}

/// A feature at a pixel of a 240x180 picture; those of one `kind` look alike.
void add_feature(const Eigen::Vector2d& pixel, std::uint8_t kind, Features* features) {
  features->pixels.push_back(pixel);
  features->bearings.push_back(
      camera_with(0.0).unproject(pixel).value().homogeneous().normalized());
  Descriptor descriptor{};
  descriptor[kind] = 250;
  // All of a kind are equally alike.
  descriptor[64U + static_cast<std::size_t>(pixel.x()) % 64U] = 10;
  features->descriptors.push_back(descriptor);
  features->tolerance_px = 1.0;
  features->tolerance_rad = 1.0 / 210.0;
}

TEST(EpipolarMatching, LeavesAloneWhatIsTwiceOnTheLine) {
  const geometry::Pose at_a;
  const geometry::Pose at_b(Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0});
  using Pixels = std::vector<Eigen::Vector2d>;
  const auto matches = [&](const Pixels& in_a, const Pixels& in_b) {
    Features a;
    Features b;
    add_feature({100.0, 40.0}, 0, &a);
    add_feature({90.0, 40.4}, 0, &b);
    for (const Eigen::Vector2d& pixel : in_a) add_feature(pixel, 1, &a);
    for (const Eigen::Vector2d& pixel : in_b) add_feature(pixel, 1, &b);
    return match_along_epipolar_lines(a, at_a, b, at_b);
  };
  const Match other{0, 0};
  using ::testing::ElementsAre;
  EXPECT_THAT(matches({{120.0, 90.0}}, {{110.0, 90.5}}), ElementsAre(other, Match{1, 1}));
  EXPECT_THAT(matches({{120.0, 90.0}}, {{110.0, 90.0}, {95.0, 90.0}}), ElementsAre(other));
  EXPECT_THAT(matches({{120.0, 90.0}, {135.0, 90.0}}, {{110.0, 90.0}}), ElementsAre(other));
  // A repetition that the other picture cuts off, seen from either side: at its edge, and where
  // it would be behind the cameras.
  EXPECT_THAT(matches({{120.0, 90.0}, {4.0, 90.0}}, {{110.0, 90.0}}), ElementsAre(other));
  EXPECT_THAT(matches({{120.0, 90.0}}, {{110.0, 90.0}, {235.0, 90.0}}), ElementsAre(other));
  // Off the line or at the same place it does no harm; alone there, or behind the cameras, it is
  // no match.
  EXPECT_THAT(matches({{120.0, 90.0}}, {{110.0, 90.0}, {95.0, 120.0}}),
              ElementsAre(other, Match{1, 1}));
  EXPECT_THAT(matches({{120.0, 90.0}}, {{110.0, 90.0}, {111.0, 90.0}}), ::testing::SizeIs(2));
  EXPECT_THAT(matches({{120.0, 90.0}}, {{110.0, 94.0}}), ElementsAre(other));
  EXPECT_THAT(matches({{120.0, 90.0}}, {{130.0, 90.0}}), ElementsAre(other));
}

/// A bright spot with a smooth edge, in the middle of nothing.
Perspective spot_at(const Eigen::Vector2d& middle, int width, int height, double sigma) {
  Perspective perspective;
  perspective.camera =
      std::make_shared<const geometry::Camera>(testing::pinhole(width, height, width));
  hal::Image gray(width, height, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double r2 = (Eigen::Vector2d(x, y) - middle).squaredNorm();
      *gray.at(x, y) = static_cast<std::uint8_t>(
          std::lround(30.0 + 200.0 * std::exp(-r2 / (2.0 * sigma * sigma))));
    }
  }
  perspective.photo = testing::photo_of(hal::to_rgb(gray));
  return perspective;
}

TEST(Features, LieWhereTheirMiddleIs) {
  for (const Eigen::Vector2d& middle : {Eigen::Vector2d(70.0, 50.0), Eigen::Vector2d(61.4, 48.7)}) {
    const Features found =
        find_features(spot_at(middle, 140, 100, 3.0), Eigen::Vector3d::UnitY(), 9);
    ASSERT_EQ(found.pixels.size(), 1U);
    EXPECT_LT((found.pixels[0] - middle).norm(), 0.06);
  }
}

TEST(Features, OfALargePictureLieOnThePictureItself) {
  const Eigen::Vector2d middle(1301.5, 803.0);
  const Features found =
      find_features(spot_at(middle, 2500, 1600, 10.0), Eigen::Vector3d::UnitY(), 9);
  ASSERT_EQ(found.pixels.size(), 1U);
  EXPECT_LT((found.pixels[0] - middle).norm(), 0.2);
  EXPECT_NEAR(found.tolerance_px, 5.0, 1e-9);  // two pixels of the picture reduced to 1000
}

TEST(Features, AreSpreadWhenTheyAreManyAndNoneOfASmallPicture) {
  const Perspective perspective = photograph(Room(), hand_at(0.0, 0.0));
  const auto top = [](const Features& features) {
    return std::count_if(features.pixels.begin(), features.pixels.end(),
                         [](const Eigen::Vector2d& pixel) { return pixel.y() < 90.0; });
  };
  const Features found = find_features(perspective, Eigen::Vector3d::UnitY(), 60);
  EXPECT_EQ(found.pixels.size(), 60U);
  EXPECT_EQ(found.descriptors.size(), 60U);
  EXPECT_GT(top(found), 15);
  EXPECT_LT(top(found), 45);
  EXPECT_TRUE(
      find_features(spot_at({5.0, 5.0}, 12, 12, 2.0), Eigen::Vector3d::UnitY(), 9).pixels.empty());
}

TEST(Neighbours, AreNearAndLookTheSameWay) {
  std::vector<Perspective> ring(72);  // looking outwards, five degrees apart
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Quaterniond turn = geometry::exp_so3({0.0, 0.0873 * static_cast<double>(i), 0.0});
    ring[i].world_from_camera = {turn, turn * Eigen::Vector3d(0.0, 0.0, 1.0)};
  }
  const auto pairs = neighbouring_pairs(ring);
  EXPECT_LE(pairs.size(), 8 * ring.size());
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    EXPECT_THAT(pairs, ::testing::Contains(std::pair(i, i + 1)));
  }
  for (const auto& [a, b] : pairs) {
    EXPECT_LE(std::min(b - a, a + ring.size() - b), 12U);
  }
  ring.resize(1);
  ring.push_back(ring[0]);
  ring[1].world_from_camera = {geometry::exp_so3({0.0, 1.2, 0.0}), Eigen::Vector3d::Zero()};
  EXPECT_TRUE(neighbouring_pairs(ring).empty());  // they look too far apart
  ring[1].world_from_camera.rotation = geometry::exp_so3({0.0, 0.9, 0.0});
  EXPECT_EQ(neighbouring_pairs(ring).size(), 1U);
  ring[1].world_from_camera.translation = ring[0].world_from_camera.translation;
  EXPECT_TRUE(neighbouring_pairs(ring).empty());
}

}  // namespace
}  // namespace lumibox::lightfield
