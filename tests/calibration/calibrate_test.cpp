#include "calibration/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "calibration/synthetic_board.h"

namespace lumibox::calibration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Reason = Refusal::Reason;

constexpr double kNoisePx = 0.2;

Request request_for(const config::CameraProfile& camera) {
  Request request;
  request.width = camera.width;
  request.height = camera.height;
  request.model = camera.model;
  return request;
}

std::vector<Sighting> sightings_of(const config::CameraProfile& camera, int views,
                                   std::uint32_t seed = 1) {
  return test::observe_all({}, camera, test::varied_poses({}, camera, views), kNoisePx, seed);
}

Calibration calibration_of(const Request& request, const std::vector<Sighting>& sightings) {
  const auto result = calibrate(request, sightings);
  const auto* refusal = std::get_if<Refusal>(&result);
  EXPECT_EQ(refusal, nullptr) << refusal->message;
  return refusal == nullptr ? std::get<Calibration>(result) : Calibration{};
}

Refusal refusal_of(const Request& request, const std::vector<Sighting>& sightings) {
  const auto result = calibrate(request, sightings);
  const auto* refusal = std::get_if<Refusal>(&result);
  EXPECT_NE(refusal, nullptr);
  return refusal == nullptr ? Refusal{} : *refusal;
}

std::map<std::string_view, double> truth_of(const config::CameraProfile& c) {
  return {{"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}, {"k1", c.k1},
          {"k2", c.k2}, {"p1", c.p1}, {"p2", c.p2}, {"k3", c.k3}, {"k4", c.k4}};
}

class Calibrate : public ::testing::TestWithParam<config::LensModel> {
 protected:
  config::CameraProfile camera_ =
      GetParam() == config::LensModel::Fisheye ? test::fisheye_camera() : test::webcam();
};

// Over many sets of noise the error in standard deviations must have a mean square of one: neither
// boast nor modesty. The mean of 20 squares lies in 0.4 to 2.2 with a probability of 0.995.
TEST_P(Calibrate, ErrsAsMuchAsItSays) {
  constexpr int kSets = 20;
  std::map<std::string_view, double> squares;
  for (std::uint32_t seed = 0; seed < kSets; ++seed) {
    const Calibration found = calibration_of(request_for(camera_), sightings_of(camera_, 18, seed));
    ASSERT_EQ(found.estimates.size(), GetParam() == config::LensModel::Fisheye ? 8U : 9U);
    EXPECT_NEAR(found.error_px, kNoisePx * std::sqrt(2.0), 0.04);
    for (const Estimate& estimate : found.estimates) {
      const double error =
          (estimate.value - truth_of(camera_).at(estimate.name)) / estimate.deviation;
      EXPECT_LT(std::abs(error), 4.5) << estimate.name;
      squares[estimate.name] += error * error / kSets;
    }
  }
  for (const auto& [name, mean] : squares) {
    EXPECT_GT(mean, 0.4) << name;
    EXPECT_LT(mean, 2.2) << name;
  }
}

TEST_P(Calibrate, IsExactWithoutNoise) {
  const auto sightings = test::observe_all({}, camera_, test::varied_poses({}, camera_, 12), 0, 0);
  const Calibration found = calibration_of(request_for(camera_), sightings);
  EXPECT_NEAR(found.profile.fx, camera_.fx, 1e-2);
  EXPECT_NEAR(found.profile.cy, camera_.cy, 1e-2);
  EXPECT_NEAR(found.profile.k1, camera_.k1, 1e-3);
  EXPECT_EQ(found.profile.model, camera_.model);
  EXPECT_EQ(found.profile.width, camera_.width);
}

TEST_P(Calibrate, DropsAViewThatContradictsTheOthers) {
  std::vector<Sighting> sightings = sightings_of(camera_, 14);
  for (Corner& corner : sightings[5]) {  // read one column off
    corner.id = corner.id / 9 * 9 + (corner.id + 1) % 9;
  }
  const Calibration found = calibration_of(request_for(camera_), sightings);
  ASSERT_EQ(found.views.size(), sightings.size());
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    EXPECT_EQ(found.views[i].dropped, i == 5) << i;
  }
  EXPECT_GT(found.views[5].error_px, 3.0 * found.error_px);
  EXPECT_NEAR(found.error_px, kNoisePx * std::sqrt(2.0), 0.03);
  EXPECT_NEAR(found.profile.fx, camera_.fx, 4.0 * found.estimates[0].deviation);
}

INSTANTIATE_TEST_SUITE_P(Models, Calibrate,
                         ::testing::Values(config::LensModel::Opencv, config::LensModel::Fisheye));

TEST(CalibrateRefuses, TooFewViews) {
  const Refusal refusal = refusal_of(request_for(test::webcam()), sightings_of(test::webcam(), 7));
  EXPECT_EQ(refusal.reason, Reason::TooFewViews);
  EXPECT_THAT(refusal.message, HasSubstr("in 7 pictures; expected 8"));
}

TEST(CalibrateRefuses, TooFewViewsThatAgree) {
  std::vector<Sighting> sightings = sightings_of(test::webcam(), 9);
  for (const std::size_t bad : {2U, 6U}) {
    for (Corner& corner : sightings[bad]) corner.id = corner.id / 9 * 9 + (corner.id + 1) % 9;
  }
  const Refusal refusal = refusal_of(request_for(test::webcam()), sightings);
  EXPECT_EQ(refusal.reason, Reason::TooFewViews);
  EXPECT_THAT(refusal.message, AllOf(HasSubstr("9 pictures"), HasSubstr("2 contradict")));
}

TEST(CalibrateRefuses, PartsOfThePictureWithoutCorners) {
  std::vector<Sighting> sightings = sightings_of(test::webcam(), 14);
  for (Sighting& sighting : sightings) {
    std::erase_if(sighting, [](const Corner& c) { return c.pixel.x() > 420; });
  }
  const Refusal refusal = refusal_of(request_for(test::webcam()), sightings);
  EXPECT_EQ(refusal.reason, Reason::NotCovered);
  EXPECT_THAT(refusal.message, HasSubstr("upper right, middle right, lower right"));
}

TEST(CalibrateRefuses, ABoardThatIsAlwaysFrontal) {
  const config::CameraProfile camera = test::webcam();
  const auto sightings =
      test::observe_all({}, camera, test::varied_poses({}, camera, 14, 2.0), 0.01, 1);
  const Refusal refusal = refusal_of(request_for(camera), sightings);
  EXPECT_EQ(refusal.reason, Reason::BoardFrontal);
  EXPECT_THAT(refusal.message, HasSubstr("degrees at most; expected 15"));
}

TEST(CalibrateRefuses, ABoardThatIsAlwaysTiltedTheSameWay) {
  const config::CameraProfile camera = test::webcam();
  std::vector<geometry::Pose> poses = test::varied_poses({}, camera, 14);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d middle = poses[i] * Eigen::Vector3d(0.1, 0.0625, 0.0);
    poses[i].rotation = geometry::exp_so3({0.45 + 0.01 * static_cast<double>(i), 0.0, 0.0});
    poses[i].translation = middle - poses[i].rotation * Eigen::Vector3d(0.1, 0.0625, 0.0);
  }
  const Refusal refusal =
      refusal_of(request_for(camera), test::observe_all({}, camera, poses, 0.01, 1));
  EXPECT_EQ(refusal.reason, Reason::ViewsAlike);
  EXPECT_THAT(refusal.message, HasSubstr("too alike"));
}

TEST(CalibrateRefuses, AnErrorThatIsTooLarge) {
  const config::CameraProfile camera = test::webcam();
  const auto sightings = test::observe_all({}, camera, test::varied_poses({}, camera, 14), 1.5, 1);
  const Refusal refusal = refusal_of(request_for(camera), sightings);
  EXPECT_EQ(refusal.reason, Reason::ErrorTooLarge);
  EXPECT_THAT(refusal.message, HasSubstr("px; expected 1 px at most"));
}

TEST(CalibrateRefuses, AFocalLengthThatIsUncertain) {
  Request request = request_for(test::webcam());
  request.limits.max_error_px = 10.0;
  const auto sightings = test::observe_all(
      {}, test::webcam(), test::varied_poses({}, test::webcam(), 14, 18.0), 2.5, 1);
  const Refusal refusal = refusal_of(request, sightings);
  EXPECT_EQ(refusal.reason, Reason::Uncertain);
  EXPECT_THAT(refusal.message, HasSubstr("% only"));
}

TEST(CalibrateRefuses, ALensThatFoldsInsideThePicture) {
  config::CameraProfile camera = test::webcam();
  camera.k1 = -0.5;
  camera.k2 = camera.k3 = 0.0;
  const auto sightings = test::observe_all({}, camera, test::varied_poses({}, camera, 14), 0.05, 1);
  const Refusal refusal = refusal_of(request_for(camera), sightings);
  EXPECT_EQ(refusal.reason, Reason::LensFolds);
  EXPECT_THAT(refusal.message, HasSubstr("turns back before pixel 0, 0"));
}

}  // namespace
}  // namespace lumibox::calibration
