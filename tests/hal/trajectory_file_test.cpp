#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "hal/replay/sequence.h"
#include "support/input_error.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::hal {
namespace {

using ::testing::HasSubstr;
using testing::TempDir;

StampedPose pose_at(double seconds, const Eigen::Quaterniond& rotation) {
  return {seconds, {rotation.normalized(), Eigen::Vector3d(1.5, -2.25, 3e-7)}};
}

RC_GTEST_PROP(TrajectoryFile, ComesBackToNineDigits, (int a, int b, int c, int d)) {
  const Eigen::Quaterniond rotation(a, b, c, d);
  RC_PRE(rotation.norm() > 0.0);
  const TempDir dir;
  const StampedPose written = pose_at(1305031102.175304, rotation);
  write_tum_trajectory(dir / "a.tum", {written});
  const std::vector<StampedPose> read = read_tum_trajectory(dir / "a.tum");
  RC_ASSERT(read.size() == 1U);
  RC_ASSERT(std::abs(read[0].timestamp_s - written.timestamp_s) < 1e-9);
  const geometry::Pose& pose = read[0].world_from_camera;
  RC_ASSERT((pose.translation - written.world_from_camera.translation).norm() < 2e-9);
  RC_ASSERT(pose.rotation.angularDistance(written.world_from_camera.rotation) < 1e-7);
  RC_ASSERT(pose.rotation.w() >= 0.0);
}

TEST(TrajectoryFile, NormalisesQuaternionsOfFewDigits) {
  const TempDir dir;
  const auto file = dir.write("a.tum", "0 0 0 0 0 0 0.7 0.71\n");
  EXPECT_NEAR(read_tum_trajectory(file)[0].world_from_camera.rotation.norm(), 1.0, 1e-15);
}

// A list of views to render has no order in time.
TEST(TrajectoryFile, TimesMayRepeat) {
  const TempDir dir;
  const auto file = dir.write("a.tum", "0 0 0 0 0 0 0 1\n0 1 0 0 0 0 0 1\n");
  EXPECT_EQ(read_tum_trajectory(file).size(), 2U);
}

TEST(TrajectoryFile, WrongNumberOfFieldsNamesTheLine) {
  const TempDir dir;
  const auto file = dir.write("a.tum", "# views\n0 0 0 0 0 0 0 1\n0 1 0 0 0 0 1\n");
  EXPECT_THAT(testing::message_of([&] { read_tum_trajectory(file); }), HasSubstr("a.tum:3"));
}

TEST(TrajectoryFile, UnwritableIsSaidByName) {
  const TempDir dir;
  EXPECT_THAT(testing::message_of([&] { write_tum_trajectory(dir / "no/a.tum", {}); }),
              HasSubstr("no/a.tum"));
}

}  // namespace
}  // namespace lumibox::hal
