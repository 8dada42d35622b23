// Fourteen pictures of a chessboard (the tenth is missing) with OpenCV's own calibration of them,
// left_intrinsics.yml: f = 535.916 px, RMS 0.393 px.
#include <gtest/gtest.h>

#include <filesystem>

#include "calibration/calibrate.h"
#include "calibration/detector.h"
#include "hal/image_io.h"

namespace lumibox::calibration {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "/usr/share/doc/opencv-doc/examples/data";

class OpencvSamples : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(fs::path(kFolder) / "left01.jpg")) {
      GTEST_SKIP() << "no pictures in " << kFolder << "; the package opencv-doc has them";
    }
  }

  static Calibration calibrate_with(const Detector& detector, bool keep_outliers) {
    std::vector<Sighting> sightings;
    for (int i = 1; i <= 14; ++i) {
      const std::string name = std::string(i < 10 ? "left0" : "left") + std::to_string(i) + ".jpg";
      if (!fs::exists(fs::path(kFolder) / name)) continue;
      const auto found = detector.find(hal::to_gray(hal::read_image(fs::path(kFolder) / name)));
      EXPECT_TRUE(found) << name;
      if (found) sightings.push_back(*found);
    }
    Request request;
    request.width = 640;
    request.height = 480;
    request.keep_outliers = keep_outliers;
    const auto result = calibrate(request, sightings);
    const auto* refusal = std::get_if<Refusal>(&result);
    EXPECT_EQ(refusal, nullptr) << refusal->message;
    return refusal == nullptr ? std::get<Calibration>(result) : Calibration{};
  }
};

// With OpenCV's sample's window, which in two of the pictures holds more than one corner.
TEST_F(OpencvSamples, GiveTheReferenceWithItsWindow) {
  const Calibration found = calibrate_with(Detector({}, 11), true);
  EXPECT_NEAR(found.profile.fx, 535.916, 0.003 * 535.916);
  EXPECT_NEAR(found.profile.fy, 535.916, 0.003 * 535.916);
  EXPECT_NEAR(found.profile.cx, 342.283, 2.0);
  EXPECT_NEAR(found.profile.cy, 235.571, 2.0);
  EXPECT_NEAR(found.error_px, 0.393, 0.03);
}

// With a window that fits, the same pictures leave half the error, and no view stands out.
TEST_F(OpencvSamples, AreBetterWithAWindowThatFits) {
  const Calibration found = calibrate_with(Detector({}), false);
  ASSERT_EQ(found.views.size(), 13U);
  EXPECT_NEAR(found.profile.fx, 533.2, 1.0);
  EXPECT_LT(found.error_px, 0.2);
  EXPECT_LT(found.estimates[0].deviation, 0.8);
  for (const View& view : found.views) EXPECT_FALSE(view.dropped);
}

// The second picture is the one whose corners the reference got wrong.
TEST_F(OpencvSamples, AViewWithWrongCornersIsDropped) {
  const Calibration found = calibrate_with(Detector({}, 11), false);
  ASSERT_EQ(found.views.size(), 13U);
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    EXPECT_EQ(found.views[i].dropped, i == 1) << i;
  }
}

}  // namespace
}  // namespace lumibox::calibration
