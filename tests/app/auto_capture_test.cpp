#include "app/auto_capture.h"

#include <gtest/gtest.h>

#include "app/moments.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using testing::around_subject;

class AutoCaptureTest : public ::testing::Test {
 protected:
  AutoCapture make(std::optional<SubjectPixel> subject) {
    return {recorder_, testing::small_camera(), config::Capture{}, dir_ / "capture", subject};
  }

  testing::TempDir dir_;
  testing::World world_;
  Recorder recorder_{testing::small_camera(), config::Capture{}, lightfield::Writing::Inline};
};

TEST_F(AutoCaptureTest, PlacesTheSphereInTheFirstGoodFrameAndLetsTheGateDecide) {
  AutoCapture capture = make(std::nullopt);
  capture.see(world_.see_nothing(tracking::TrackingReason::MoveSideways));
  EXPECT_FALSE(capture.placed());
  for (int i = 0; i < 60; ++i) {
    capture.see(world_.see_from(around_subject(0.01 * i)));
  }
  EXPECT_TRUE(capture.placed());
  EXPECT_TRUE(recorder_.light_field().subject()->center.isApprox(Eigen::Vector3d::UnitZ(), 1e-2));
  EXPECT_EQ(recorder_.light_field().perspectives().size(), 9U)
      << "0.59 rad in steps above 4 degrees";
}

TEST_F(AutoCaptureTest, WaitsForTheFrameOfTheSubject) {
  AutoCapture capture = make(SubjectPixel{{41.5, 23.5}, 3});
  for (int i = 0; i < 3; ++i) {
    capture.see(world_.see_from({}));
    EXPECT_FALSE(capture.placed());
  }
  capture.see(world_.see_from({}));
  ASSERT_TRUE(capture.placed());
  const Eigen::Vector3d subject = recorder_.light_field().subject()->center;
  EXPECT_NEAR(subject.x() / subject.z(), 10.0 / 60.0, 1e-9);
  EXPECT_EQ(recorder_.light_field().perspectives().size(), 1U);
}

}  // namespace
}  // namespace lumibox::app
