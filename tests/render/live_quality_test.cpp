#include "render/live_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>
#include <utility>

#include "geometry/rotation.h"
#include "render/docket.h"
#include "render/image_quality.h"
#include "render/ray_cast.h"
#include "render/reduced.h"
#include "support/photo.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr double kDegree = std::numbers::pi / 180.0;
const lightfield::Sphere kBall{Eigen::Vector3d::Zero(), 1.0};

/// A walk past the ball in three rows, as a gate of six degrees records it.
std::vector<Perspective> walk(int columns = 6, int rows = 3) {
  std::vector<Perspective> perspectives;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double across = 6.5 * kDegree * (column + 0.2 * row - 0.5 * columns);
      const double up = 6.5 * kDegree * (row - 0.5 * rows);
      const Eigen::Vector3d center(4.0 * std::sin(across) * std::cos(up), 4.0 * std::sin(up),
                                   -4.0 * std::cos(across) * std::cos(up));
      const Eigen::Vector3d target(0.05 * std::sin(3.0 * column), 0.05 * std::cos(2.0 * row), 0.0);
      perspectives.push_back(test::photograph_perspective(
          static_cast<int>(perspectives.size()), test::textured_ball(1.0),
          test::make_camera(64, 48), test::look_at(center, target, 0.05 * std::sin(column))));
    }
  }
  return perspectives;
}

/// Nobody stands out.
constexpr config::Quality kNoAppeals{
    .disagreement_sigmas = 100.0, .least_shift_deg = 45.0, .least_difference = 255.0};

constexpr std::size_t kMiddle = 8;  // of walk(): with others all around

template <typename Change>
void change_picture(Perspective& perspective, const Change& change) {
  hal::Image picture = *perspective.photo->rgb();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) change(picture.at(x, y), x, y);
  }
  perspective.photo = testing::photo_of(std::move(picture));
}

void expose(Perspective& perspective, double factor) {
  change_picture(perspective, [&](std::uint8_t* pixel, int, int) {
    for (int c = 0; c < 3; ++c) {
      pixel[c] = static_cast<std::uint8_t>(std::min(255.0, std::round(factor * pixel[c])));
    }
  });
}

struct Outcome {
  int slices = 0;
  std::vector<Ruling> rulings;
  std::vector<int> disagreeing;
};

/// All that there is to judge, judged.
Outcome judge_all(Docket& docket, const std::vector<Perspective>& perspectives) {
  docket.set(perspectives, kBall);
  Outcome outcome;
  while (docket.judge_next()) ++outcome.slices;
  outcome.rulings = docket.rulings();
  for (const Ruling& ruling : outcome.rulings) {
    if (ruling.disagrees) outcome.disagreeing.push_back(ruling.id);
  }
  return outcome;
}

Outcome judge_all(const std::vector<Perspective>& perspectives) {
  Docket docket({}, {});
  return judge_all(docket, perspectives);
}

TEST(Docket, JudgesEachOnceAndNobodyDisagreesInACleanCapture) {
  const auto perspectives = walk();
  Docket without_appeals({}, kNoAppeals);
  EXPECT_EQ(judge_all(without_appeals, perspectives).slices, 18);
  const Outcome outcome = judge_all(perspectives);
  ASSERT_EQ(outcome.rulings.size(), 18U);
  for (const Ruling& ruling : outcome.rulings) EXPECT_GT(ruling.psnr, 22.0) << ruling.id;
  EXPECT_TRUE(outcome.disagreeing.empty());
}

TEST(Docket, APoseThatIsOffDisagreesAndItsNeighboursDoNot) {
  for (const double off_deg : {1.0, 2.0}) {
    for (const int which : {0, 1, 2}) {
      auto perspectives = walk();
      geometry::Pose& pose = perspectives[kMiddle].world_from_camera;
      const double off = off_deg * kDegree;
      if (which == 0) pose.rotation = pose.rotation * geometry::exp_so3({0.0, off, 0.0});
      if (which == 1) pose.rotation = pose.rotation * geometry::exp_so3({off, 0.0, 0.0});
      if (which == 2) {  // seen from S
        pose.translation = geometry::exp_so3({0.0, off, 0.0}) * pose.translation;
      }
      const std::vector<int> expected{static_cast<int>(kMiddle)};
      EXPECT_EQ(judge_all(perspectives).disagreeing, expected) << off_deg << " " << which;
    }
  }
}

TEST(Docket, TwoBadOnesAreBothTold) {
  auto perspectives = walk();
  for (const std::size_t i : {std::size_t{1}, kMiddle + 2}) {
    geometry::Pose& pose = perspectives[i].world_from_camera;
    pose.rotation = pose.rotation * geometry::exp_so3({0.0, 1.5 * kDegree, 0.0});
  }
  const std::vector<int> expected{1, static_cast<int>(kMiddle) + 2};
  EXPECT_EQ(judge_all(perspectives).disagreeing, expected);
}

// What is very bad spoils the depth of those around it too.
TEST(Docket, WhatAMuchWorseNeighbourMayHaveCausedIsExcused) {
  auto perspectives = walk();
  for (const auto& [index, off_deg] : {std::pair{kMiddle, 5.0}, {kMiddle + 1, 0.8}}) {
    geometry::Pose& pose = perspectives[index].world_from_camera;
    pose.rotation = pose.rotation * geometry::exp_so3({0.0, off_deg * kDegree, 0.0});
  }
  Docket docket({}, {});
  EXPECT_EQ(judge_all(docket, perspectives).disagreeing, std::vector<int>{kMiddle});
  perspectives.erase(perspectives.begin() + kMiddle);
  EXPECT_EQ(judge_all(docket, perspectives).disagreeing, std::vector<int>{kMiddle + 1})
      << "until that one is gone";
}

TEST(Docket, APictureWithAnOccluderDisagrees) {
  for (const double left : {0.35, 0.5}) {
    auto perspectives = walk();
    change_picture(perspectives[kMiddle], [&](std::uint8_t* pixel, int x, int y) {
      if (x < left * 64 || x > (left + 0.2) * 64 || y < 14) return;
      pixel[0] = 90;
      pixel[1] = 60;
      pixel[2] = 50;
    });
    EXPECT_EQ(judge_all(perspectives).disagreeing, std::vector<int>{kMiddle}) << left;
  }
}

TEST(Docket, AnotherExposureDisagreesAStepThatLastsDoesNot) {
  auto perspectives = walk();
  expose(perspectives[kMiddle], 1.3);
  EXPECT_EQ(judge_all(perspectives).disagreeing, std::vector<int>{kMiddle});
  perspectives = walk();
  for (std::size_t i = kMiddle; i < perspectives.size(); ++i) expose(perspectives[i], 1.15);
  EXPECT_TRUE(judge_all(perspectives).disagreeing.empty());
}

// All others look aside, so that their pictures end within the ball.
TEST(Judge, WhatNobodyElseCoversSaysNothingAboutThePose) {
  auto perspectives = walk();
  for (Perspective& p : perspectives) {
    if (p.id == static_cast<int>(kMiddle)) continue;
    p = test::photograph_perspective(p.id, test::textured_ball(1.0), *p.camera,
                                     test::look_at(p.center(), {1.6, 0.0, 0.0}));
  }
  Judge judge({});
  const auto jury = jury_of(perspectives, kMiddle, kBall.center).members;
  const Judgement aside = judge.judge(perspectives, kMiddle, jury, kBall);
  EXPECT_LT(aside.psnr, 18.0) << "but it is seen";
  EXPECT_LT(aside.shift, 0.5 * kDegree);
  EXPECT_LT(aside.difference, 12.0);
  for (Perspective& p : perspectives) {
    if (p.id == static_cast<int>(kMiddle)) continue;
    p = test::photograph_perspective(p.id, test::textured_ball(1.0), *p.camera,
                                     test::look_at(p.center(), {3.5, 0.0, 0.0}));
  }
  Judge another({});
  EXPECT_TRUE(std::isnan(another.judge(perspectives, kMiddle, jury, kBall).shift));
}

TEST(Docket, AWipedOneIsForgottenAndOnlyThoseThatItWasAskedAboutAreJudgedAgain) {
  auto perspectives = walk();
  Docket docket({}, kNoAppeals);
  judge_all(docket, perspectives);
  std::size_t asked = 0;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    const auto jury = jury_of(perspectives, i, kBall.center).members;
    asked += std::ranges::find(jury, kMiddle) == jury.end() ? 0 : 1;
  }
  ASSERT_LT(asked, perspectives.size() - 1);
  perspectives.erase(perspectives.begin() + kMiddle);
  const Outcome outcome = judge_all(docket, perspectives);
  EXPECT_EQ(outcome.slices, static_cast<int>(asked));
  EXPECT_EQ(outcome.rulings.size(), perspectives.size());
  EXPECT_TRUE(std::ranges::none_of(outcome.rulings,
                                   [](const Ruling& ruling) { return ruling.id == kMiddle; }));
}

TEST(Docket, ACorrectedPoseAgreesAgainAndWhatDoesNotChangeStays) {
  auto perspectives = walk();
  const geometry::Pose good = perspectives[kMiddle].world_from_camera;
  perspectives[kMiddle].world_from_camera.rotation =
      good.rotation * geometry::exp_so3({0.0, 1.5 * kDegree, 0.0});
  Docket docket({}, {});
  EXPECT_FALSE(judge_all(docket, perspectives).disagreeing.empty());
  EXPECT_EQ(judge_all(docket, perspectives).slices, 0);
  perspectives[kMiddle].world_from_camera = good;
  EXPECT_TRUE(judge_all(docket, perspectives).disagreeing.empty());
}

TEST(Docket, NobodyIsToldToDisagreeOnEvidenceThatHasChanged) {
  auto perspectives = walk();
  change_picture(perspectives[kMiddle],
                 [](std::uint8_t* pixel, int, int) { std::fill_n(pixel, 3, std::uint8_t{60}); });
  Docket docket({}, {});
  EXPECT_EQ(judge_all(docket, perspectives).disagreeing, std::vector<int>{kMiddle});
  const auto disagrees = [&] {
    return std::ranges::any_of(docket.rulings(), [](const Ruling& r) { return r.disagrees; });
  };
  perspectives.erase(perspectives.begin() + kMiddle + 1);
  docket.set(perspectives, kBall);
  EXPECT_FALSE(disagrees());
  while (docket.judge_next()) {
  }
  EXPECT_TRUE(disagrees());
}

TEST(Docket, NewOnesComeBeforeThoseThatChanged) {
  const auto perspectives = walk();
  std::vector<Perspective> first(perspectives.begin(), perspectives.end() - 1);
  Docket docket({}, {});
  judge_all(docket, first);
  docket.set(perspectives, kBall);
  ASSERT_TRUE(docket.judge_next());
  EXPECT_EQ(docket.rulings().back().id, perspectives.back().id);
}

TEST(Docket, FewPerspectivesAndNoSubjectInSightAreNoError) {
  for (const int columns : {0, 1, 2}) {
    const Outcome outcome = judge_all(walk(columns, 1));
    EXPECT_EQ(outcome.rulings.size(), columns < 2 ? 0U : 2U);
    EXPECT_TRUE(outcome.disagreeing.empty());
  }
  auto perspectives = walk(3, 1);
  for (Perspective& p : perspectives) {
    p.world_from_camera.rotation =
        p.world_from_camera.rotation * geometry::exp_so3({0.0, std::numbers::pi, 0.0});
  }
  EXPECT_TRUE(judge_all(perspectives).rulings.empty());
}

lightfield::LightField light_field_of(const std::vector<Perspective>& perspectives) {
  return {perspectives, kBall};
}

TEST(LiveQuality, AtOnceJudgesOneACallAndIsTheSameEachTime) {
  const auto light_field = light_field_of(walk(4, 2));
  LiveQuality first({}, {}, Estimating::AtOnce);
  LiveQuality second({}, {}, Estimating::AtOnce);
  for (std::size_t calls = 1; calls <= 8; ++calls) {
    const CaptureQuality& quality = first.watch(light_field);
    EXPECT_EQ(quality.psnr.size(), calls);
    EXPECT_EQ(quality.psnr, second.watch(light_field).psnr);
  }
  std::vector<double> all;
  for (const auto& [id, psnr] : first.watch(light_field).psnr) all.push_back(psnr);
  std::ranges::sort(all);
  EXPECT_EQ(first.watch(light_field).median_psnr, 0.5 * (all[3] + all[4]));
}

TEST(LiveQuality, MeanwhileComesToTheSame) {
  const auto light_field = light_field_of(walk(3, 1));
  LiveQuality at_once({}, {}, Estimating::AtOnce);
  for (int i = 0; i < 3; ++i) at_once.watch(light_field);
  LiveQuality meanwhile({}, {}, Estimating::Meanwhile);
  while (meanwhile.watch(light_field).psnr.size() < 3) std::this_thread::yield();
  EXPECT_EQ(meanwhile.watch(light_field).psnr, at_once.watch(light_field).psnr);
  const auto other = light_field_of(walk(3, 1));
  EXPECT_TRUE(meanwhile.watch(other).psnr.empty()) << "the same ids, but not the same pictures";
}

TEST(LiveQuality, TellsOnlyOfWhatIsThere) {
  auto light_field = light_field_of(walk(4, 2));
  LiveQuality live({}, {}, Estimating::AtOnce);
  for (int i = 0; i < 8; ++i) live.watch(light_field);
  light_field.wipe(3);
  EXPECT_FALSE(live.watch(light_field).psnr.contains(3));
  light_field.undo_wipe();
  for (int i = 0; i < 20; ++i) live.watch(light_field);
  EXPECT_TRUE(live.watch(light_field).psnr.contains(3));
  // A new capture has the same ids.
  const auto other = light_field_of(walk(4, 2));
  EXPECT_EQ(live.watch(other).psnr.size(), 1U);
  EXPECT_TRUE(live.watch(lightfield::LightField{}).psnr.empty());
}

// Darker than those around it: the gain comes at once to be known, and slowly to be seen.
TEST(LiveQuality, TellsGainsOfPicturesOfAnotherExposure) {
  auto perspectives = walk(4, 2);
  expose(perspectives[3], 0.7);
  auto light_field = light_field_of(perspectives);
  const auto points = [] {
    std::vector<Eigen::Vector3d> front;
    for (int i = 0; i < 300; ++i) {
      const double z = -1.0 + 0.5 * (i + 0.5) / 300.0;
      const double r = std::sqrt(1.0 - z * z);
      front.emplace_back(r * std::cos(2.4 * i), r * std::sin(2.4 * i), z);
    }
    return front;
  };
  for (const Estimating estimating : {Estimating::AtOnce, Estimating::Meanwhile}) {
    LiveQuality live({}, {}, estimating);
    EXPECT_LT(live.watch(light_field, points).gains.at(3), 1.1);
    while (live.watch(light_field, points).psnr.size() < 8) std::this_thread::yield();
    for (int i = 0; i < 100; ++i) live.watch(light_field, points);
    const auto gains = live.watch(light_field, points).gains;
    // 0.7 of the stored value is some 0.45 of the light.
    EXPECT_NEAR(gains.at(3) / gains.at(2), 1.0 / 0.45, 0.3);
    EXPECT_NEAR(gains.at(1) / gains.at(2), 1.0, 0.05);
    light_field.wipe(3);
    EXPECT_FALSE(live.watch(light_field, points).gains.contains(3));
    light_field.undo_wipe();
  }
  LiveQuality pointless({}, {}, Estimating::AtOnce);
  for (int i = 0; i < 20; ++i) pointless.watch(light_field);
  for (const auto& [id, gain] : pointless.watch(light_field).gains) EXPECT_EQ(gain, 1.0);
}

TEST(LiveQuality, EndsWhileItWorks) {
  const auto light_field = light_field_of(walk());
  LiveQuality live({}, {}, Estimating::Meanwhile);
  live.watch(light_field);
}

TEST(Disagreement, IsToldAgainstTheSpreadOfTheOthers) {
  std::vector<Judged> judged;
  for (int i = 0; i < 11; ++i) {
    const Judgement judgement{30.0, (0.1 + 0.01 * i) * kDegree, 5.0 + i};
    judged.push_back({judgement, judgement, 0.07});
  }
  config::Quality options;
  options.least_shift_deg = 0.01;
  options.least_difference = 1.0;
  const auto limits = limits_of(judged, options);
  ASSERT_TRUE(limits);
  // Medians 0.15 degrees and 10 grey levels; median distances from there three steps.
  EXPECT_NEAR(limits->shift, (0.15 + 5.0 * 1.4826 * 0.03) * kDegree, 1e-9);
  EXPECT_NEAR(limits->difference, 10.0 + 5.0 * 1.4826 * 3.0, 1e-9);
  options.least_shift_deg = 2.0;
  EXPECT_NEAR(limits_of(judged, options)->shift, 2.0 * kDegree, 1e-12);

  Judged bad{{20.0, 1.0 * kDegree, 5.0}, std::nullopt, 0.07};
  EXPECT_TRUE(stands_out(bad, *limits));
  EXPECT_EQ(severity(bad, *limits), 0.0) << "no appeal yet";
  bad.appeal = Judgement{20.0, 0.1 * kDegree, 5.0};
  EXPECT_LT(severity(bad, *limits), 1.0) << "one half of the jury agrees with it";
  bad.appeal = Judgement{20.0, 3.0 * limits->shift, 2.0 * limits->difference};
  EXPECT_NEAR(severity(bad, *limits), 3.0, 1e-9);
  bad.appeal->shift = std::nan("");
  EXPECT_NEAR(severity(bad, *limits), 2.0, 1e-9);
  bad.nearest = 0.3;
  EXPECT_FALSE(stands_out(bad, *limits)) << "nobody is near enough to tell";
  EXPECT_EQ(severity(bad, *limits), 0.0);
  judged.resize(5);
  EXPECT_FALSE(limits_of(judged, options)) << "too few to have a spread";
}

TEST(Reduced, IsTheSamePictureOfASmallerCamera) {
  const test::World world = test::textured_ball(1.0);
  const auto pose = test::look_at({0.3, 0.2, -4.0}, {0, 0, 0});
  const Perspective large =
      test::photograph_perspective(7, world, test::make_camera(160, 120), pose);
  const Perspective small = *reduced(large, 5000);
  EXPECT_EQ(small.id, 7);
  ASSERT_EQ(small.photo->width(), 80);
  ASSERT_EQ(small.photo->height(), 60);
  EXPECT_GT(psnr(*small.photo->rgb(), test::photograph(world, *small.camera, pose)), 35.0);
  EXPECT_EQ(reduced(large, 160 * 120)->photo->rgb(), large.photo->rgb());
}

}  // namespace
}  // namespace lumibox::render
