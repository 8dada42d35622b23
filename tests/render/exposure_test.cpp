#include "render/exposure.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "render/ball_scene.h"
#include "render/image_quality.h"
#include "render/light.h"
#include "render/reference.h"
#include "support/photo.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

hal::Image exposed(const hal::Image& image, double factor) {
  hal::Image result(image.width(), image.height(), 3);
  for (std::size_t i = 0; i < image.size_bytes(); ++i) {
    const double light = factor * light_of(static_cast<double>(image.data()[i]));
    result.data()[i] = static_cast<std::uint8_t>(std::lround(stored_of(light)));
  }
  return result;
}

/// The perspective as a camera with another exposure would have taken it.
Perspective exposed(Perspective perspective, double factor) {
  perspective.photo = testing::photo_of(exposed(*perspective.photo->rgb(), factor));
  return perspective;
}

Perspective uniform(Perspective perspective, std::uint8_t value) {
  hal::Image image(perspective.photo->width(), perspective.photo->height(), 3);
  std::fill_n(image.data(), image.size_bytes(), value);
  perspective.photo = testing::photo_of(std::move(image));
  return perspective;
}

/// The perspectives with the gains that Exposure finds.
std::vector<Perspective> equally_bright(std::vector<Perspective> perspectives,
                                        const Eigen::Vector3d& focus,
                                        const std::vector<Eigen::Vector3d>& points) {
  const std::vector<double> gains = Exposure().gains(perspectives, focus, points);
  for (std::size_t i = 0; i < perspectives.size(); ++i) perspectives[i].gain = gains[i];
  return perspectives;
}

/// A ball before a shell far away.
const std::vector<Perspective>& capture() {
  static const std::vector<Perspective> perspectives = around_a_ball(test::make_camera(96, 72), 16);
  return perspectives;
}

std::vector<double> factors_of(std::size_t count, std::uint32_t seed) {
  std::srand(seed);
  std::vector<double> factors;
  for (std::size_t i = 0; i < count; ++i) factors.push_back(0.6 + 0.1 * (std::rand() % 7));
  return factors;
}

std::vector<Perspective> exposed(std::vector<Perspective> perspectives,
                                 const std::vector<double>& factors) {
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    perspectives[i] = exposed(perspectives[i], factors[i]);
  }
  return perspectives;
}

/// Largest deviation of gain * factor from its geometric mean over some pictures, as a share.
double spread(const std::vector<double>& gains, const std::vector<double>& factors,
              std::size_t begin = 0) {
  double sum = 0.0;
  for (std::size_t i = begin; i < gains.size(); ++i) sum += std::log(gains[i] * factors[i]);
  const double mean = sum / static_cast<double>(gains.size() - begin);
  double worst = 0.0;
  for (std::size_t i = begin; i < gains.size(); ++i) {
    worst = std::max(worst, std::abs(std::log(gains[i] * factors[i]) - mean));
  }
  return worst;
}

/// Points of the ball's front, evenly by the golden angle.
const std::vector<Eigen::Vector3d>& points() {
  static const std::vector<Eigen::Vector3d> points = [] {
    std::vector<Eigen::Vector3d> on_ball;
    for (int i = 0; i < 400; ++i) {
      const double z = -1.0 + 0.5 * (i + 0.5) / 400.0;
      const double r = std::sqrt(1.0 - z * z);
      on_ball.emplace_back(r * std::cos(2.4 * i), r * std::sin(2.4 * i), z);
    }
    return on_ball;
  }();
  return points;
}

std::vector<double> gains_of(const std::vector<Perspective>& perspectives) {
  return Exposure().gains(perspectives, kSubject, points());
}

// 1 %: what nobody sees. Nothing here hangs on chance.
TEST(Exposure, OfEqualExposuresIsOneWithinAPerCent) {
  for (const double gain : gains_of(capture())) EXPECT_NEAR(gain, 1.0, 0.01);
}

RC_GTEST_PROP(ExposureProperty, KnownFactorsAreUndoneUpToACommonOne, ()) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < capture().size(); ++i) {
    factors.push_back(0.01 * *rc::gen::inRange(50, 130));
  }
  const auto pictures = exposed(capture(), factors);
  // The prior keeps a twentieth of what changes slowly over the pictures.
  RC_ASSERT(spread(gains_of(pictures), factors) < 0.05);
}

TEST(Exposure, AnOccluderOrAWrongPoseInOnePictureDoesNotSpoilOthers) {
  const std::vector<double> factors = factors_of(capture().size(), 2);
  const auto pictures = exposed(capture(), factors);
  auto occluded = pictures;
  {
    hal::Image image = *pictures[0].photo->rgb();
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width() * 2 / 3; ++x) std::fill_n(image.at(x, y), 3, 40);
    }
    occluded[0].photo = testing::photo_of(std::move(image));
  }
  auto turned = pictures;
  turned[0].world_from_camera.rotation =
      turned[0].world_from_camera.rotation * geometry::exp_so3({0.0, 0.4, 0.3});
  for (const auto& spoilt : {occluded, turned}) {
    EXPECT_LT(spread(gains_of(spoilt), factors, 1), 0.03);
  }
}

TEST(Exposure, OnePictureNoPointsOrNoOverlapIsOne) {
  const auto unequal = exposed(capture(), factors_of(capture().size(), 6));
  for (const double gain : Exposure().gains(unequal, kSubject, {})) EXPECT_EQ(gain, 1.0);
  EXPECT_TRUE(gains_of({}).empty());
  EXPECT_EQ(gains_of({capture()[0]}), std::vector<double>{1.0});
  auto apart = std::vector<Perspective>{capture()[0], exposed(capture()[1], 0.5)};
  apart[1].world_from_camera.rotation =
      apart[1].world_from_camera.rotation * geometry::exp_so3({0.0, 3.0, 0.0});
  EXPECT_EQ(gains_of(apart), (std::vector<double>{1.0, 1.0}));
}

TEST(Exposure, NoPictureOrALostOneIsOneAndTheOthersAreAsWithout) {
  auto pictures = exposed(capture(), factors_of(capture().size(), 3));
  pictures[4].photo = nullptr;
  const auto gains = gains_of(pictures);
  EXPECT_EQ(gains[4], 1.0);
  pictures.erase(pictures.begin() + 4);
  const auto without = gains_of(pictures);
  for (std::size_t i = 0; i < without.size(); ++i) {
    EXPECT_NEAR(gains[i < 4 ? i : i + 1], without[i], 1e-9);
  }
}

TEST(Exposure, BlackAndWhitePicturesAreOne) {
  for (const int value : {0, 255}) {
    auto pictures = exposed(capture(), factors_of(capture().size(), 4));
    pictures[3] = uniform(pictures[3], static_cast<std::uint8_t>(value));
    EXPECT_EQ(gains_of(pictures)[3], 1.0);
    for (Perspective& picture : pictures) {
      picture = uniform(picture, static_cast<std::uint8_t>(value));
    }
    for (const double gain : gains_of(pictures)) EXPECT_EQ(gain, 1.0);
  }
}

TEST(Exposure, StaysFiniteAndBoundedAtHardViews) {
  auto pictures = capture();
  pictures[0].world_from_camera.translation = kSubject;
  pictures[1].world_from_camera = pictures[2].world_from_camera;
  pictures[3].world_from_camera.rotation =
      test::look_at({0.0, 0.0, -4.0}, {9.0, 0.0, -4.0}).rotation;
  pictures[4] = exposed(pictures[4], 0.02);
  for (const double gain : gains_of(pictures)) {
    EXPECT_GE(gain, 0.25);
    EXPECT_LE(gain, 4.0);
  }
}

TEST(Gains, AreBoundedWhateverTheRatiosSay) {
  const auto gains = gains_from(2, {{0, 1, 20.0, 1e-6}});
  EXPECT_EQ(gains[0], 4.0);
  EXPECT_EQ(gains[1], 0.25);
}

TEST(Gains, OneBadRatioIsOutvoted) {
  const double step = std::log(1.2);
  const auto gains = gains_from(4, {{0, 1, step, 0.002},
                                    {1, 2, -step, 0.002},
                                    {2, 3, step, 0.002},
                                    {0, 3, step, 0.002},
                                    {0, 2, 0.0, 0.002},
                                    {1, 3, 1.5, 0.002}});
  EXPECT_NEAR(gains[0] / gains[1], 1.2, 0.02);
  EXPECT_NEAR(gains[0] / gains[2], 1.0, 0.02);
  EXPECT_NEAR(gains[0] / gains[3], 1.2, 0.02);
}

TEST(EasedGains, ComeFromOneWithoutAJumpAndArrive) {
  EasedGains eased;
  double before = 1.0;
  for (int tick = 0; tick < 120; ++tick) {
    const double now = eased.step({{7, 2.0}}).at(7);
    EXPECT_GE(now, before);
    EXPECT_LT(now / before, 1.08) << "a step of a fourteenth of the light";
    before = now;
  }
  EXPECT_NEAR(before, 2.0, 1e-3);
  EXPECT_TRUE(eased.step({}).empty());
  EXPECT_LT(eased.step({{7, 2.0}}).at(7), 1.1) << "another one of this id";
}

/// Mean of the differences where the mask is not 0, grey levels.
double mean_difference(const hal::Image& a, const hal::Image& b, const hal::Image& mask) {
  double sum = 0.0;
  double count = 0.0;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if (*mask.at(x, y) == 0) continue;
      for (int c = 0; c < 3; ++c) sum += std::abs(a.at(x, y)[c] - b.at(x, y)[c]);
      count += 3.0;
    }
  }
  return sum / count;
}

// What gains are for: exposures that step by a third between pictures, seen along a path. The truth
// is the scene at the mean exposure, which is what the gains' common factor makes.
TEST(Exposure, TakesTheFlickerOutOfAPath) {
  const test::World world = test::textured_plane(kSubject, Eigen::Vector3d::UnitZ());
  const auto equal_exposures =
      test::random_capture(world, test::make_camera(96, 72), 24, 4.0, 0.3, 5);
  std::vector<Eigen::Vector3d> on_plane;
  for (int i = 0; i < 400; ++i)
    on_plane.emplace_back(0.1 * (i % 20 - 10), 0.1 * (i / 20 - 10), 0.0);
  const std::vector<double> factors = factors_of(equal_exposures.size(), 5);
  double sum = 0.0;
  for (const double factor : factors) sum += std::log(factor);
  const double mean = std::exp(sum / static_cast<double>(factors.size()));
  const auto pictures = exposed(equal_exposures, factors);
  const auto equal = equally_bright(pictures, kSubject, on_plane);
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.exponent = 8.0;
  double flicker[2] = {};
  double likeness[2] = {};
  hal::Image last[3];
  for (int i = 0; i < 12; ++i) {
    const View view = view_from({0.1 * (i - 6), 0.05 * (i - 6), -4.0});
    const hal::Image truth =
        exposed(test::photograph(world, view.camera, view.world_from_camera), mean);
    const hal::Image seen[2] = {render_reference(view, pictures, settings),
                                render_reference(view, equal, settings)};
    const hal::Image mask = subject_mask(view, {kSubject, 0.8});
    for (int g = 0; g < 2; ++g) {
      likeness[g] += psnr(seen[g], truth, &mask) / 12.0;
      if (i > 0) {
        flicker[g] +=
            mean_difference(seen[g], last[g], mask) - mean_difference(truth, last[2], mask);
      }
      last[g] = seen[g];
    }
    last[2] = truth;
  }
  EXPECT_GT(likeness[1], likeness[0] + 10.0);
  EXPECT_LT(flicker[1], 0.1 * flicker[0]);
}

}  // namespace
}  // namespace lumibox::render
