#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>

#include "geometry/camera.h"
#include "hal/sim_scenes.h"

// Shadows, baked when the scene is loaded or traced in every frame, against geometry.
namespace lumibox::hal {
namespace {

using testing::scene_of;

/// A white floor under a vertical light, seen from the side. `moved` moves all of it.
std::string floor_scene(const std::string& shadows, const Eigen::Vector3d& moved,
                        const std::string& extra = "") {
  const auto at = [&](double x, double y, double z) {
    const Eigen::Vector3d p = moved + Eigen::Vector3d(x, y, z);
    return "[" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
           std::to_string(p.z()) + "]";
  };
  return R"(
duration_s = 1.0
background = [0.0, 0.0, 0.0]
camera = { width = 320, height = 240, fx = 300.0 }
lights = [{ kind = "directional", direction = [0.0, 0.0, -1.0], softness_deg = 0.0, strength = 0.8, shadows = ")" +
         shadows + "\" }]\nsubject = { center = " + at(0, 0, 0) +
         ", radius_m = 0.5 }\npath = { keys = [{ time_s = 0.0, at = " + at(0, -2.5, 2) +
         ", target = " + at(0, 0, 0) + R"( }] }
[[objects]]
name = "floor"
shape = "quad"
size = [2.0, 2.0, 0.0]
segments = 100
at = )" + at(0, 0, 0) +
         "\n" + extra;
}

constexpr const char* kBox = R"(
[[objects]]
name = "box"
shape = "box"
size = [0.4, 0.4, 0.1]
at = [0.0, 0.0, 0.5]
)";

class SimShadow : public ::testing::TestWithParam<const char*> {};

// The box spans 0.2 m to each side of what lies below it; the floor's light is baked every 0.02 m.
TEST_P(SimShadow, LiesBelowWhatCastsItAndEndsWhereThatEnds) {
  const auto scene = scene_of(floor_scene(GetParam(), Eigen::Vector3d::Zero(), kBox));
  const geometry::Camera camera(scene->profile());
  const geometry::Pose camera_from_world = scene->world_from_camera(0.0).inverse();
  const Image image = testing::frame_alone(scene, 0);
  const auto brightness = [&](double x, double y) {
    const auto pixel = camera.project(camera_from_world * Eigen::Vector3d(x, y, 0.0));
    return static_cast<int>(
        image.at(static_cast<int>(pixel->x() + 0.5), static_cast<int>(pixel->y() + 0.5))[1]);
  };
  for (const double side : {-1.0, 1.0}) {
    EXPECT_LT(brightness(side * 0.17, 0.0), 10) << side;
    EXPECT_GT(brightness(side * 0.23, 0.0), 150) << side;
  }
  EXPECT_LT(brightness(0.0, 0.0), 10);
  EXPECT_LT(brightness(0.0, -0.17), 10);
  EXPECT_GT(brightness(0.0, -0.23), 150);
}

// Rays that left the floor from where rounding puts it would meet it again, in specks. Far from the
// origin the coordinates are rounded more coarsely.
TEST_P(SimShadow, NothingShadesItself) {
  for (const double far : {0.0, 3.3, 57.7}) {
    const Eigen::Vector3d moved(far, -0.7 * far, 0.3 * far);
    const Image shaded = testing::frame_alone(scene_of(floor_scene(GetParam(), moved)), 0);
    const Image plain = testing::frame_alone(scene_of(floor_scene("none", moved)), 0);
    ASSERT_FALSE(plain.empty());
    EXPECT_TRUE(shaded == plain) << far;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SimShadow, ::testing::Values("baked", "traced"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace lumibox::hal
