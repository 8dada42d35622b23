#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "hal/image_io.h"
#include "hal/replay/sequence.h"
#include "hal/sim_scenes.h"
#include "support/input_error.h"

namespace lumibox::hal {
namespace {

using lumibox::testing::message_of;
using lumibox::testing::TempDir;
using testing::scene_of;
using testing::wall_scene;

TEST(SimSequence, ReadsBackAsItWasWalked) {
  const auto scene =
      scene_of(wall_scene("[[effects]]\nkind = \"lens_distortion\"\nk1 = 0.1\nk3 = 0.01\n"
                          "[[effects]]\nkind = \"rolling_shutter\"\nreadout_s = 0.01\n"));
  const TempDir folder;
  std::int64_t done = 0;
  write_sequence(*scene, folder / "seq", [&](std::int64_t frame, std::int64_t total) {
    EXPECT_EQ(frame, ++done);
    EXPECT_EQ(total, 20);
  });
  const Sequence sequence = open_sequence(folder / "seq");
  EXPECT_EQ(sequence.profile.k1, 0.1);
  EXPECT_EQ(sequence.profile.k3, 0.01);
  EXPECT_EQ(sequence.profile.readout_s, 0.01);
  EXPECT_EQ(sequence.profile.fps, 20.0);
  ASSERT_EQ(sequence.entries.size(), 20u);
  ASSERT_EQ(sequence.ground_truth.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(sequence.entries[i].timestamp_ns, scene->timestamp_ns(static_cast<std::int64_t>(i)));
    const geometry::Pose expected = scene->world_from_camera(static_cast<double>(i) / 20.0);
    const geometry::Pose& written = sequence.ground_truth[i].world_from_camera;
    EXPECT_LT((written.translation - expected.translation).norm(), 1e-9);
    EXPECT_LT(written.rotation.angularDistance(expected.rotation), 1e-7);
  }
  ASSERT_TRUE(sequence.subject.has_value());
  EXPECT_EQ(sequence.subject->center, Eigen::Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(read_image(sequence.entries[7].image), testing::frame_alone(scene, 7));
}

// Whoever kills a long simulation has the part that was done.
TEST(SimSequence, IsWholeAfterEveryPicture) {
  const auto scene = scene_of(wall_scene());
  const TempDir folder;
  write_sequence(*scene, folder / "seq", [&](std::int64_t frame, std::int64_t) {
    const Sequence so_far = open_sequence(folder / "seq");
    EXPECT_EQ(so_far.entries.size(), static_cast<std::size_t>(frame));
    EXPECT_EQ(so_far.ground_truth.size(), static_cast<std::size_t>(frame));
  });
}

TEST(SimSequence, OccupiedFolderIsRefused) {
  const auto scene = scene_of(wall_scene());
  const TempDir folder;
  folder.write("old/photo.png", "");
  EXPECT_THAT(message_of([&] { write_sequence(*scene, folder / "old", {}); }),
              ::testing::HasSubstr("is not empty"));
  EXPECT_THAT(message_of([&] { write_sequence(*scene, folder / "old/photo.png", {}); }),
              ::testing::HasSubstr("is a file"));
}

}  // namespace
}  // namespace lumibox::hal
