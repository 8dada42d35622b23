#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "geometry/rotation.h"
#include "numerics/trap.h"
#include "render/view.h"
#include "support/photo.h"

namespace lumibox::render {
namespace {

using ProxyNumerics = Trapped;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
const double kArcs[] = {0.0,        1e-16,      1e-13,       1e-12,       1e-11,
                        1e-8,       1e-4,       0.1,         0.5 * kPi,   3.0,
                        kPi - 1e-4, kPi - 1e-8, kPi - 1e-10, kPi - 2e-12, kPi};

/// Sides to which an arc may leave `from`.
std::vector<Vector3d> sides_of(const Vector3d& from) {
  const auto basis = geometry::tangent_basis(from);
  std::vector<Vector3d> sides;
  for (int i = 0; i < 16; ++i) {
    const double angle = kPi * i / 8.0;
    sides.push_back(basis * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return sides;
}

// 2e-15: ten roundings. The share of the arc that is passed is exact from 0 to antiparallel, where
// the arc is any one.
TEST_F(ProxyNumerics, SlerpPassesItsShareOfTheArc) {
  const Vector3d from = Vector3d(0.3, -0.5, 0.8).normalized();
  for (const Vector3d& side : sides_of(from)) {
    for (const double arc : kArcs) {
      const Vector3d to = (std::cos(arc) * from + std::sin(arc) * side).normalized();
      for (const double t : {0.0, 1e-9, 0.25, 0.5, 0.75, 1.0}) {
        const Vector3d between = geometry::slerp(from, to, t);
        EXPECT_NEAR(between.norm(), 1.0, 4e-16);
        EXPECT_NEAR(geometry::angle_between(from, between), t * arc, 2e-15) << arc << ' ' << t;
        EXPECT_NEAR(geometry::angle_between(between, to), (1.0 - t) * arc, 2e-15)
            << arc << ' ' << t;
      }
    }
  }
}

// Both ends are met: a proxy plane at 90 degrees and beyond is the perspective's own.
TEST_F(ProxyNumerics, SlerpMeetsBothEnds) {
  const Vector3d from = Vector3d(0.3, -0.5, 0.8).normalized();
  for (const Vector3d& side : sides_of(from)) {
    for (const double arc : kArcs) {
      const Vector3d to = (std::cos(arc) * from + std::sin(arc) * side).normalized();
      EXPECT_LT((geometry::slerp(from, to, 0.0) - from).norm(), 1e-15) << arc;
      EXPECT_LT((geometry::slerp(from, to, 1.0) - to).norm(), 1e-15) << arc;
    }
  }
}

/// Looks at the origin, turned about y by `angle` from looking along z.
lightfield::Perspective turned_by(double angle) {
  lightfield::Perspective p;
  p.world_from_camera.rotation = geometry::exp_so3({0.0, angle, 0.0});
  p.world_from_camera.translation = p.world_from_camera.rotation * Vector3d(0.0, 0.0, -4.0);
  p.photo = testing::photo_of(hal::Image(64, 48, 3));
  config::CameraProfile profile;
  profile.width = 64;
  profile.height = 48;
  profile.fx = profile.fy = 60.0;
  profile.cx = 31.5;
  profile.cy = 23.5;
  p.camera = std::make_shared<const geometry::Camera>(profile);
  return p;
}

// Thesis 3.1 at the angles named: 0, 90 degrees and antiparallel, and a hair beside them. A normal
// that jumped would make the picture jump. 1e-12: a millionth of a pixel at any focal length.
TEST_F(ProxyNumerics, NormalsAreContinuousAtTheHardAngles) {
  const lightfield::Perspective own = turned_by(0.0);
  const View view{*own.camera, own.world_from_camera};
  for (const double angle : {0.0, 1e-15, 1e-9, 0.5 * kPi - 1e-9, 0.5 * kPi, 0.5 * kPi + 1e-9,
                             kPi - 1e-9, kPi - 1e-13, kPi}) {
    const auto layers = plan_view(view, {turned_by(angle)}, Settings{});
    if (std::abs(angle - 0.5 * kPi) < 1e-6) {
      EXPECT_TRUE(layers.empty());  // the perspective's own plane is edge-on for the view
      continue;
    }
    ASSERT_EQ(layers.size(), 1U) << angle;
    const double share = std::min(1.0, angle / (0.5 * kPi));
    EXPECT_NEAR(geometry::angle_between(Vector3d::UnitZ(), layers[0].normal), share * angle, 1e-12);
    EXPECT_TRUE(layers[0].source_from_pixel.allFinite());
    EXPECT_EQ(layers[0].weight, 1.0);
  }
}

}  // namespace
}  // namespace lumibox::render
