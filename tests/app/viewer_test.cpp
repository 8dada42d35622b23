#include "app/viewer.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <memory>

#include "render/gl_test.h"
#include "render/image_quality.h"
#include "render/ray_cast.h"

namespace lumibox::app {
namespace {

using test::look_at;
using test::make_camera;

/// A machine on which each look at the clock is some time after the one before: what is measured
/// takes that long.
class SlowClock : public hal::Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_ += step_ns; }
  void wait_until(std::int64_t deadline_ns) override { now_ns_ = std::max(now_ns_, deadline_ns); }

  std::int64_t step_ns = 0;

 private:
  mutable std::int64_t now_ns_ = 0;
};

constexpr std::int64_t kMs = 1'000'000;
constexpr double kBudgetMs = 20.0;

class ViewerTest : public test::GlTest {
 protected:
  void SetUp() override {
    display_ = open_display(160, 120);
    if (!display_) return;
    viewer_ = make_viewer(clock_);
    shown_.perspectives =
        test::random_capture(test::textured_ball(1.0), make_camera(160, 120), 12, 4.0, 0.4, 5);
    shown_.geometry = render::Geometry::Plane;
  }

  std::unique_ptr<Viewer> make_viewer(const hal::Clock& clock) const {
    auto viewer = std::make_unique<Viewer>(clock, config::Render{}, render::Estimating::AtOnce);
    viewer->begin_drawing();
    return viewer;
  }

  hal::Image draw(double across) {
    const render::View view{make_camera(160, 120), look_at({across, 0.2, -3.8}, {0, 0, 0})};
    viewer_->draw(shown_, view, display_->framebuffer(), kBudgetMs);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return display_->read_back();
  }

  /// Until it is known that there is no time for all of it.
  void draw_slowly() {
    clock_.step_ns = 50 * kMs;
    for (int i = 0; i < 5; ++i) draw(-0.1 * i);
  }

  hal::Image full(double across) {
    SlowClock quick;
    const std::unique_ptr<Viewer> viewer = make_viewer(quick);
    const render::View view{make_camera(160, 120), look_at({across, 0.2, -3.8}, {0, 0, 0})};
    viewer->draw(shown_, view, display_->framebuffer(), kBudgetMs);
    return display_->read_back();
  }

  std::unique_ptr<hal::OffscreenDisplay> display_;
  SlowClock clock_;
  std::unique_ptr<Viewer> viewer_;
  LightFieldPicture shown_;
};

TEST_F(ViewerTest, WithTimeEnoughEveryPictureIsAtFullQuality) {
  for (int i = 0; i < 20; ++i) EXPECT_EQ(draw(0.01 * i), full(0.01 * i));
}

TEST_F(ViewerTest, WithoutTimeItIsLessButTheSamePicture) {
  draw_slowly();
  const hal::Image drawn = draw(0.1);
  const hal::Image expected = full(0.1);
  EXPECT_NE(drawn, expected);
  EXPECT_GT(render::psnr(drawn, expected), 24.0);
}

TEST_F(ViewerTest, AViewThatRestsIsRefinedWithinHalfASecond) {
  draw_slowly();
  const hal::Image moving = draw(0.1);
  const hal::Image expected = full(0.1);
  EXPECT_NE(moving, expected);
  clock_.step_ns = 3 * kMs;  // of a band
  hal::Image drawn = moving;
  for (int tick = 0; tick < 15; ++tick) drawn = draw(0.1);
  EXPECT_EQ(drawn, expected);
  EXPECT_EQ(draw(0.1), expected) << "and stays";
  EXPECT_EQ(draw(0.1 + 1e-4), expected) << "under a hand that trembles";
  clock_.step_ns = 50 * kMs;
  EXPECT_NE(draw(0.3), full(0.3)) << "until it moves";
}

TEST_F(ViewerTest, WhatIsShownAtRestFollowsTheLightField) {
  draw_slowly();
  clock_.step_ns = 3 * kMs;
  for (int tick = 0; tick < 20; ++tick) draw(0.0);
  shown_.perspectives.erase(shown_.perspectives.begin(), shown_.perspectives.begin() + 6);
  draw(0.0);
  hal::Image drawn = draw(0.0);
  for (int tick = 0; tick < 20; ++tick) drawn = draw(0.0);
  EXPECT_EQ(drawn, full(0.0));
}

/// All at once what is drawn at rest bit by bit.
hal::Image bokeh_of(const LightFieldPicture& shown, const render::View& view,
                    hal::OffscreenDisplay& display) {
  render::Renderer renderer;
  render::LightMean mean;
  render::ProxyGeometry proxy({}, render::Estimating::AtOnce);
  render::Bokeh bokeh(view, shown.perspectives, shown.settings);
  while (bokeh.prepare(proxy) && bokeh.is_possible() && !bokeh.is_complete()) {
    bokeh.draw(renderer, mean, view.camera.height());
  }
  mean.draw(display.framebuffer());
  return display.read_back();
}

TEST_F(ViewerTest, AWideApertureOnTheShapeIsSmoothAtRest) {
  shown_.settings.aperture = render::Aperture::Wide;
  shown_.settings.aperture_views = 9;
  const hal::Image on_planes = full(0.1);
  shown_.geometry = render::Geometry::Mesh;
  const render::View view{make_camera(160, 120), look_at({0.1, 0.2, -3.8}, {0, 0, 0})};
  const hal::Image smooth = bokeh_of(shown_, view, *display_);
  EXPECT_NE(smooth, on_planes);
  for (int tick = 0; tick < 6; ++tick) EXPECT_EQ(draw(0.1), on_planes) << "moving: " << tick;
  int ticks = 0;
  while (draw(0.1) == on_planes && ticks < 20) ++ticks;
  EXPECT_EQ(ticks, 9) << "a view in each tick of a clock on which nothing takes time";
  EXPECT_EQ(draw(0.1), smooth);
  EXPECT_NE(draw(0.3), smooth) << "until it moves";
}

TEST_F(ViewerTest, TheSmoothApertureComesOnASlowMachineToo) {
  shown_.settings.aperture = render::Aperture::Wide;
  shown_.settings.aperture_views = 2;
  shown_.geometry = render::Geometry::Mesh;
  draw_slowly();
  const render::View view{make_camera(160, 120), look_at({0.1, 0.2, -3.8}, {0, 0, 0})};
  const hal::Image smooth = bokeh_of(shown_, view, *display_);
  clock_.step_ns = 3 * kMs;
  hal::Image drawn = draw(0.1);
  for (int tick = 0; tick < 60; ++tick) drawn = draw(0.1);
  EXPECT_EQ(drawn, smooth);
}

TEST(Motion, CountsTurningAndMovingInPixels) {
  const geometry::Camera camera = make_camera(160, 120);
  const double f = camera.profile().fx;
  const render::View from{camera, look_at({0, 0, -4}, {0, 0, 0})};
  const render::View moved{camera, {from.world_from_camera.rotation, {0.04, 0, -4}}};
  EXPECT_NEAR(motion_px(from, moved, {0, 0, 0}), 0.01 * f, 1e-3 * f);
  const render::View rolled{camera, look_at({0, 0, -4}, {0, 0, 0}, 0.02)};
  EXPECT_NEAR(motion_px(from, rolled, {0, 0, 0}), 0.02 * f, 1e-6);
  EXPECT_EQ(motion_px(from, from, from.world_from_camera.translation), 0.0) << "at the focus";
}

}  // namespace
}  // namespace lumibox::app
