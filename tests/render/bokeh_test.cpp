#include "render/bokeh.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "config/error.h"
#include "config/loader.h"
#include "render/gl_test.h"
#include "render/image_quality.h"
#include "render/light.h"
#include "render/ray_cast.h"
#include "render/read_ahead.h"
#include "support/photo.h"
#include "support/temp_dir.h"

namespace lumibox::render {
namespace {

using Eigen::Vector3d;
using lightfield::Perspective;

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr double kWall = 2.0;  // behind S, which is at 0; the views are at -4
constexpr double kSpot = 0.1;  // radius

/// A dim wall with texture, a light spot on it or not, and a bright tile in the focus plane.
test::World wall(bool with_spot) {
  const test::World pattern = test::textured_plane({0.0, 0.0, kWall}, Vector3d::UnitZ());
  const test::World tile = test::textured_plane({0.0, 0.0, 0.0}, Vector3d::UnitZ());
  return [=](const test::Ray& ray) -> Vector3d {
    const auto at = [&](double z) {
      return (ray.origin + (z - ray.origin.z()) / ray.direction.z() * ray.direction).eval();
    };
    const Vector3d near = at(0.0);
    if (std::abs(near.x() + 1.3) < 0.5 && std::abs(near.y()) < 0.8) return tile(ray);
    if (with_spot && (at(kWall) - Vector3d(0.6, 0.0, kWall)).norm() < kSpot) {
      return Vector3d::Ones();
    }
    return 0.4 * pattern(ray);
  };
}

std::vector<Perspective> capture(bool with_spot) {
  return test::random_capture(wall(with_spot), test::make_camera(kWidth, kHeight), 16, 4.0, 0.25,
                              7);
}

Settings wide() {
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.exponent = 0.0;  // a disc is alike all over
  settings.k = 12;
  return settings;
}

View from_the_front() {
  return {test::make_camera(kWidth, kHeight), test::look_at({0.0, 0.0, -4.0}, {0.0, 0.0, 0.0})};
}

class BokehTest : public test::GlTest {
 protected:
  void SetUp() override {
    display_ = open_display(kWidth, kHeight);
    if (!display_) return;
    renderer_ = std::make_unique<Renderer>();
    mean_ = std::make_unique<LightMean>();
  }

  hal::Image draw(const std::vector<Perspective>& perspectives, const Settings& settings,
                  int rows = kHeight) {
    ProxyGeometry proxy({}, Estimating::AtOnce);
    Bokeh bokeh(from_the_front(), perspectives, settings);
    while (bokeh.prepare(proxy) && bokeh.is_possible() && !bokeh.is_complete()) {
      bokeh.draw(*renderer_, *mean_, rows);
    }
    EXPECT_TRUE(bokeh.is_complete());
    mean_->draw(display_->framebuffer());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return display_->read_back();
  }

  hal::Image draw_recorded(const std::vector<Perspective>& perspectives, const Settings& settings) {
    renderer_->draw(from_the_front(), perspectives, settings, display_->framebuffer());
    return display_->read_back();
  }

  std::unique_ptr<hal::OffscreenDisplay> display_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<LightMean> mean_;
};

/// How uneven the spot's light is where all of the aperture should show it: largest over mean, in
/// the middle of its disc.
double unevenness(const hal::Image& with_spot, const hal::Image& without, double radius_px) {
  const geometry::Camera camera = test::make_camera(kWidth, kHeight);
  const Eigen::Vector2d middle = *camera.project(Vector3d(0.6, 0.0, 4.0 + kWall));
  double largest = 0.0;
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if ((Eigen::Vector2d(x, y) - middle).norm() > radius_px) continue;
      const double light = light_of(static_cast<double>(with_spot.at(x, y)[1])) -
                           light_of(static_cast<double>(without.at(x, y)[1]));
      largest = std::max(largest, light);
      sum += light;
      ++count;
    }
  }
  return largest * count / sum;
}

TEST(LightMean, HoldsAsManyPicturesAsMayBeConfigured) {
  const auto load = [](int views) {
    return config::load(
        {.system_file = {}, .assignments = {"render.aperture_views=" + std::to_string(views)}});
  };
  EXPECT_EQ(load(LightMean::kMost).render.aperture_views, LightMean::kMost);
  EXPECT_THROW(load(LightMean::kMost + 1), config::InputError);
}

TEST_F(BokehTest, APointOutOfFocusIsASmoothDisc) {
  const auto spot = capture(true);
  const auto none = capture(false);
  const Settings settings = wide();
  const double limit = aperture_limit(from_the_front(), spot, settings);
  // Of the disc: f r (1 / z_focus - 1 / z).
  const double radius_px = from_the_front().camera.profile().fx * 4.0 * std::tan(limit) *
                           (1.0 / 4.0 - 1.0 / (4.0 + kWall));
  ASSERT_GT(radius_px, 5.0);
  const double inner_px = 0.7 * radius_px;
  const double copies =
      unevenness(draw_recorded(spot, settings), draw_recorded(none, settings), inner_px);
  const double smooth = unevenness(draw(spot, settings), draw(none, settings), inner_px);
  EXPECT_GT(copies, 2.5) << "one of each recorded picture";
  EXPECT_LT(smooth, 1.8);
}

TEST_F(BokehTest, WhatIsInFocusIsAsRecorded) {
  const hal::Image drawn = draw(capture(true), wide());
  const View view = from_the_front();
  const hal::Image truth = test::photograph(wall(true), view.camera, view.world_from_camera);
  const auto corner = view.camera.project(Vector3d(-1.7, -0.7, 4.0));
  const auto opposite = view.camera.project(Vector3d(-0.9, 0.7, 4.0));
  double sum = 0.0;
  int count = 0;
  for (int y = static_cast<int>(corner->y()); y < static_cast<int>(opposite->y()); ++y) {
    for (int x = static_cast<int>(corner->x()); x < static_cast<int>(opposite->x()); ++x) {
      for (int c = 0; c < 3; ++c, ++count) {
        sum += std::abs(drawn.at(x, y)[c] - truth.at(x, y)[c]);
      }
    }
  }
  EXPECT_GT(count, 1000);
  EXPECT_LT(sum / count, 4.0);
}

double mean_difference(const hal::Image& a, const hal::Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) sum += std::abs(a.data()[i] - b.data()[i]);
  return sum / static_cast<double>(a.size_bytes());
}

TEST_F(BokehTest, AgreesWithTheReference) {
  const auto perspectives = capture(true);
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Settings settings = wide();
  settings.exponent = 2.0;
  for (const int views : {1, 11}) {  // one group and a part of one
    settings.aperture_views = views;
    const auto expected = render_bokeh_reference(from_the_front(), perspectives, settings, proxy);
    ASSERT_TRUE(expected.has_value());
    EXPECT_LT(mean_difference(draw(perspectives, settings), *expected), 0.5) << views;
  }
}

TEST_F(BokehTest, BitByBitItIsTheSame) {
  const auto perspectives = capture(false);
  Settings settings = wide();
  settings.aperture_views = 9;
  EXPECT_EQ(draw(perspectives, settings, 7), draw(perspectives, settings));
}

// A view that was drawn of those pictures that were there by then would stay in the mean.
TEST_F(BokehTest, WaitsForPicturesThatAreReadMeanwhile) {
  const testing::TempDir dir;
  const auto perspectives = capture(false);
  Settings settings = wide();
  settings.aperture_views = 3;
  const hal::Image expected = draw(perspectives, settings);

  std::vector<Perspective> stored = perspectives;
  for (Perspective& p : stored) {
    const auto photo = testing::photo_of(hal::Image(*p.photo->require_rgb()));
    testing::store_as_png(*photo, dir / (std::to_string(p.id) + ".png"));
    p.photo = photo;
  }
  ReadAhead ahead;
  Renderer renderer({}, &ahead);
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Bokeh bokeh(from_the_front(), stored, settings);
  for (int draws = 0; draws < 1000 && !bokeh.is_complete(); ++draws) {
    ASSERT_TRUE(bokeh.prepare(proxy));
    bokeh.draw(renderer, *mean_, 50);
    if (draws % 3 == 2) ahead.read_next();
  }
  ASSERT_TRUE(bokeh.is_complete());
  mean_->draw(display_->framebuffer());
  EXPECT_EQ(display_->read_back(), expected);
}

TEST_F(BokehTest, WithoutPerspectivesOrAPlaneInFocusThereIsNone) {
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Bokeh nothing(from_the_front(), {}, wide());
  EXPECT_TRUE(nothing.prepare(proxy));
  EXPECT_FALSE(nothing.is_possible());
  Settings behind = wide();
  behind.focus = {0.0, 0.0, -5.0};
  EXPECT_FALSE(Bokeh(from_the_front(), capture(false), behind).is_possible());
}

TEST_F(BokehTest, OnePerspectiveIsShown) {
  std::vector<Perspective> one = capture(false);
  one.resize(1);
  Settings settings = wide();
  settings.aperture_views = 2;
  const hal::Image drawn = draw(one, settings);
  int brightest = 0;
  for (std::size_t i = 0; i < drawn.size_bytes(); ++i) {
    brightest = std::max<int>(brightest, drawn.data()[i]);
  }
  EXPECT_GT(brightest, 100);
}

TEST_F(BokehTest, TheMeanIsOfLight) {
  for (const int count : {1, 8, 11, LightMean::kMost}) {
    mean_->begin(kWidth, kHeight);
    double light = 0.0;
    for (int i = 0; i < count; ++i) {
      const int level = 255 * (i * 37 % 64) / 63;
      glBindFramebuffer(GL_FRAMEBUFFER, mean_->framebuffer());
      const float shade = static_cast<float>(level) / 255.0F;
      glClearColor(shade, 0.5F * shade, 0.0F, 1.0F);
      glClear(GL_COLOR_BUFFER_BIT);
      mean_->add();
      light += light_of(static_cast<double>(level)) / count;
    }
    mean_->draw(display_->framebuffer());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    const hal::Image drawn = display_->read_back();
    EXPECT_NEAR(drawn.at(80, 60)[0], stored_of(light), 1.5) << count;
    EXPECT_EQ(drawn.at(80, 60)[2], 0);
  }
}

// Beside what was recorded the mean is of the views that see something.
TEST_F(BokehTest, TheMeanIsOfWhatIsCovered) {
  const auto mean_of = [&](int seen, int empty) {
    mean_->begin(kWidth, kHeight);
    for (int i = 0; i < seen + empty; ++i) {
      glBindFramebuffer(GL_FRAMEBUFFER, mean_->framebuffer());
      glClearColor(i < seen ? 0.6F : 0.0F, 0.0F, 0.0F, i < seen ? 1.0F : 0.0F);
      glClear(GL_COLOR_BUFFER_BIT);
      mean_->add();
    }
    mean_->draw(display_->framebuffer());
    return static_cast<double>(display_->read_back().at(80, 60)[0]);
  };
  EXPECT_NEAR(mean_of(10, 8), 153.0, 1.5);
  EXPECT_NEAR(mean_of(4, 12), stored_of(0.5 * light_of(153.0)), 1.5) << "and fades";
  EXPECT_EQ(mean_of(0, 9), 0.0);
}

}  // namespace
}  // namespace lumibox::render
