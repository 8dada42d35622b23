#include "tracking/corner_tracks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "geometry/rotation.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

std::shared_ptr<const FlowPicture> picture(const hal::Image& image) {
  return std::make_shared<const FlowPicture>(std::make_shared<const Pyramid>(image, 3));
}

hal::Image turned(double angle) {
  return testing::render_wedge(testing::small_camera(),
                               {geometry::exp_so3({0.0, angle, 0.0}), Eigen::Vector3d::Zero()});
}

TEST(CornerTracks, FollowATurnToATenthOfAPixel) {
  const geometry::Camera camera = testing::small_camera();
  CornerTracks tracks(picture(turned(0.0)), 0, 10);
  for (int i = 1; i <= 6; ++i) tracks.follow(picture(turned(0.01 * i)), i, camera);
  ASSERT_EQ(tracks.times_ns().size(), 7U);
  ASSERT_GT(tracks.tracks().size(), 150U);
  int exact = 0;
  for (const CornerTracks::Track& track : tracks.tracks()) {
    ASSERT_EQ(track.path.size(), 7U);
    const Eigen::Vector3d ray = camera.unproject(track.path.front())->homogeneous();
    const auto expected = camera.project(geometry::exp_so3({0.0, -0.06, 0.0}) * ray);
    exact += (*expected - track.path.back()).norm() < 0.1 ? 1 : 0;
  }
  // Seven tenths: the rest are corners of coarser levels and on the wedge's edge.
  EXPECT_GE(10 * exact, 7 * static_cast<int>(tracks.tracks().size()));
}

// One half of the picture has ten times the contrast of the other. The corners come from both.
TEST(CornerTracks, CornersComeFromAllOverThePicture) {
  hal::Image image(640, 480, 1);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const double grain = testing::noise(u / 60.0, v / 60.0) - 128.0;
      const double contrast = u < 320 ? 1.0 : 0.3;
      *image.at(u, v) = static_cast<std::uint8_t>(std::clamp(128.0 + contrast * grain, 0.0, 255.0));
    }
  }
  const CornerTracks tracks(picture(image), 0, 10);
  const auto right = std::ranges::count_if(
      tracks.tracks(), [](const auto& track) { return track.path.front().x() > 320.0; });
  EXPECT_GE(5 * right, 2 * static_cast<std::ptrdiff_t>(tracks.tracks().size()));
}

TEST(CornerTracks, AStillCameraLeavesOnlyTheViewsAtTheEnds) {
  CornerTracks tracks(picture(turned(0.0)), 0, 10);
  for (int i = 1; i <= 10; ++i) tracks.follow(picture(turned(0.0)), i, testing::small_camera());
  EXPECT_EQ(tracks.frames(), 10);
  EXPECT_EQ(tracks.times_ns(), (std::vector<std::int64_t>{0, 1, 9, 10}));
  for (const CornerTracks::Track& track : tracks.tracks()) EXPECT_EQ(track.path.size(), 4U);
  EXPECT_EQ(tracks.still_until_ns(), 10);
  tracks.follow(picture(turned(0.05)), 11, testing::small_camera());
  EXPECT_EQ(tracks.still_until_ns(), 10);
}

TEST(CornerTracks, OfManyViewsSomeAreForgottenButNotTheEnds) {
  const auto here = picture(turned(0.0));
  const auto there = picture(turned(0.05));
  CornerTracks tracks(here, 0, 10);
  for (int i = 1; i <= 150; ++i) tracks.follow(there, i, testing::small_camera());
  EXPECT_LE(tracks.times_ns().size(), 60U);
  EXPECT_GE(tracks.times_ns().size(), 25U);
  EXPECT_EQ(tracks.times_ns().front(), 0);
  EXPECT_EQ(tracks.times_ns().back(), 150);
  EXPECT_TRUE(std::ranges::is_sorted(tracks.times_ns()));
  EXPECT_EQ(tracks.tracks().front().path.size(), tracks.times_ns().size());
}

}  // namespace
}  // namespace lumibox::tracking
