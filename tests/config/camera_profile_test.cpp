#include "config/camera_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "config/loader.h"
#include "support/input_error.h"
#include "support/temp_dir.h"

namespace lumibox::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kMinimal =
    "width = 320\nheight = 240\nfx = 270\nfy = 271\ncx = 160\ncy = 120\n";

class CameraProfileFile : public ::testing::Test {
 protected:
  CameraProfile load_text(const std::string& text) const {
    return load_camera_profile(folder_.write("webcam.toml", text));
  }
  std::string complaint_about(const std::string& text) const {
    return testing::message_of([&] { load_text(text); });
  }
  testing::TempDir folder_;
};

TEST_F(CameraProfileFile, GivesWhatItSaysAndNoDistortionOtherwise) {
  const CameraProfile profile = load_text(std::string(kMinimal) + "k2 = -0.5\nreadout_s = 0.03\n");
  EXPECT_EQ(profile.width, 320);
  EXPECT_EQ(profile.height, 240);
  EXPECT_EQ(profile.fx, 270.0);
  EXPECT_EQ(profile.fy, 271.0);
  EXPECT_EQ(profile.cx, 160.0);
  EXPECT_EQ(profile.cy, 120.0);
  EXPECT_EQ(profile.k1, 0.0);
  EXPECT_EQ(profile.k2, -0.5);
  EXPECT_EQ(profile.fps, 30.0);
  EXPECT_EQ(profile.readout_s, 0.03);
}

TEST_F(CameraProfileFile, NamesTheLensModel) {
  EXPECT_EQ(load_text(kMinimal).model, LensModel::Opencv);
  const CameraProfile profile =
      load_text("model = \"fisheye\"\nk4 = 0.25\n" + std::string(kMinimal));
  EXPECT_EQ(profile.model, LensModel::Fisheye);
  EXPECT_EQ(profile.k4, 0.25);
  EXPECT_THAT(complaint_about("model = \"FOV\"\n" + std::string(kMinimal)),
              AllOf(HasSubstr("webcam.toml:1"), HasSubstr("opencv, fisheye")));
}

TEST_F(CameraProfileFile, WithACoefficientOfTheOtherModelIsRefused) {
  EXPECT_THAT(complaint_about(std::string(kMinimal) + "k4 = 0.1\n"), HasSubstr("k4 is 0.1"));
  EXPECT_THAT(complaint_about(std::string(kMinimal) + "model = \"fisheye\"\np2 = 0.1\n"),
              HasSubstr("p2 is 0.1"));
}

TEST_F(CameraProfileFile, ReadsBackWhatWasWrittenToTheLastBit) {
  CameraProfile profile;
  profile.model = LensModel::Fisheye;
  profile.fx = 1000.0 / 3.0;
  profile.k1 = -0.1;
  profile.k4 = 1e-7 / 3.0;
  profile.readout_s = 0.02;
  const CameraProfile back = load_text(profile_text(profile));
  EXPECT_EQ(back.model, profile.model);
  EXPECT_EQ(back.width, profile.width);
  EXPECT_EQ(back.fx, profile.fx);
  EXPECT_EQ(back.k1, profile.k1);
  EXPECT_EQ(back.k4, profile.k4);
  EXPECT_EQ(back.readout_s, profile.readout_s);
}

TEST_F(CameraProfileFile, WithoutARequiredKeyIsRefused) {
  EXPECT_THAT(complaint_about("width = 320\nheight = 240\nfx = 270\n"),
              AllOf(HasSubstr("webcam.toml"), HasSubstr("'fy'")));
}

TEST_F(CameraProfileFile, UnknownKeyNamesLineAndNeighbour) {
  EXPECT_THAT(complaint_about("widht = 320\n"),
              AllOf(HasSubstr("webcam.toml:1"), HasSubstr("did you mean 'width'")));
}

TEST_F(CameraProfileFile, WrongTypeNamesLine) {
  EXPECT_THAT(complaint_about("# camera\nwidth = 320.5\n"),
              AllOf(HasSubstr("webcam.toml:2"), HasSubstr("width")));
}

TEST_F(CameraProfileFile, PrincipalPointFarOutsideIsRefused) {
  EXPECT_THAT(
      complaint_about("width = 320\nheight = 240\nfx = 270\nfy = 270\ncx = 1600\ncy = 120\n"),
      AllOf(HasSubstr("webcam.toml"), HasSubstr("cx is 1600")));
}

TEST(CameraProfile, DefaultIsPlausible) {
  EXPECT_EQ(fault_of(CameraProfile{}), std::nullopt);
}

TEST(CameraProfile, EachNumberIsChecked) {
  CameraProfile profile;
  double* const numbers[] = {&profile.fx, &profile.fy,  &profile.cx,       &profile.cy,
                             &profile.k1, &profile.k2,  &profile.p1,       &profile.p2,
                             &profile.k3, &profile.fps, &profile.readout_s};
  const char* const names[] = {"fx", "fy", "cx", "cy",  "k1",       "k2",
                               "p1", "p2", "k3", "fps", "readout_s"};
  for (std::size_t i = 0; i < std::size(numbers); ++i) {
    const double before = *numbers[i];
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), -1e9}) {
      *numbers[i] = bad;
      EXPECT_THAT(fault_of(profile).value_or(""), HasSubstr(names[i]));
    }
    *numbers[i] = before;
  }
}

TEST(CameraProfile, ZeroFocalLengthIsRefused) {
  CameraProfile profile;
  profile.fy = 0.0;
  EXPECT_THAT(fault_of(profile).value_or(""), HasSubstr("fy is 0"));
}

}  // namespace
}  // namespace lumibox::config
