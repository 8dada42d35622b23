#include "bench/naive_quads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "render/gl_test.h"
#include "render/ray_cast.h"
#include "render/reference.h"
#include "render/renderer.h"

namespace lumibox::bench {
namespace {

using lightfield::Perspective;
using test::look_at;
using test::make_camera;

// The quads are blended in a framebuffer of eight bits: each of them rounds by half a grey level at
// most, and what lies below keeps a share of 0.6 of its error; faded borders have eight bits too, and
// where little light is, in sRGB a step of those is several levels.
constexpr double kMeanTolerance = 0.5;
constexpr int kLargestTolerance = 10;

struct Difference {
  double mean = 0.0;
  int largest = 0;
};

Difference difference(const hal::Image& a, const hal::Image& b) {
  EXPECT_EQ(a.size_bytes(), b.size_bytes());
  Difference result;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) {
    const int here = std::abs(a.data()[i] - b.data()[i]);
    result.mean += here / static_cast<double>(a.size_bytes());
    result.largest = std::max(result.largest, here);
  }
  return result;
}

class NaiveQuadsTest : public test::GlTest {
 protected:
  void SetUp() override {
    display_ = open_display(160, 120);
    if (!display_) return;
    glGenRenderbuffers(1, &stored_);
    glBindRenderbuffer(GL_RENDERBUFFER, stored_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, 160, 120);
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, stored_);
  }

  hal::Image draw(NaiveQuads& quads, const render::View& view,
                  const std::vector<Perspective>& perspectives, const render::Settings& settings) {
    quads.draw(view, perspectives, settings, framebuffer_);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    std::vector<std::uint8_t> rgba(std::size_t{160} * 120 * 4);
    glReadPixels(0, 0, 160, 120, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    hal::Image image(160, 120, 3);
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        std::copy_n(&rgba[static_cast<std::size_t>(4 * ((119 - y) * 160 + x))], 3, image.at(x, y));
      }
    }
    return image;
  }

  std::unique_ptr<hal::OffscreenDisplay> display_;
  GLuint framebuffer_ = 0;  // in sRGB, so that the GL blends light; gone with the context
  GLuint stored_ = 0;
};

TEST_F(NaiveQuadsTest, ShowWhatTheRendererShows) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(160, 120), 30, 4.0, 0.5, 7);
  NaiveQuads quads(NaiveQuads::Blending::Light);
  render::Renderer renderer;
  for (const int k : {1, 2, 10, 40}) {
    for (const double across : {-0.5, 0.3}) {
      const render::View view{make_camera(160, 120), look_at({across, 0.2, -3.7}, {0, 0, 0}, 0.2)};
      render::Settings settings;
      settings.k = k;
      settings.focus = Eigen::Vector3d(0.1, 0.0, 0.2);
      const hal::Image drawn = draw(quads, view, perspectives, settings);
      renderer.draw(view, perspectives, settings, display_->framebuffer());
      const Difference from_renderer = difference(drawn, display_->read_back());
      EXPECT_LT(from_renderer.mean, kMeanTolerance) << "k " << k;
      EXPECT_LE(from_renderer.largest, kLargestTolerance) << "k " << k;
      const Difference from_reference =
          difference(drawn, render::render_reference(view, perspectives, settings));
      EXPECT_LT(from_reference.mean, kMeanTolerance) << "k " << k;
      EXPECT_LE(from_reference.largest, kLargestTolerance) << "k " << k;
    }
  }
}

// Where the nearest pictures end others show through their faded borders, and beyond all is black.
TEST_F(NaiveQuadsTest, FadeAtTheBordersAsTheRendererDoes) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(90, 60), 8, 4.0, 0.4, 3);
  config::CameraProfile wide_angle = make_camera(160, 120).profile();
  wide_angle.fx = wide_angle.fy = 60.0;
  const render::View view{geometry::Camera(wide_angle), look_at({0.2, 0.1, -4.0}, {0.3, 0, 0})};
  const hal::Image expected = render::render_reference(view, perspectives, {});
  ASSERT_TRUE(std::all_of(expected.at(0, 0), expected.at(1, 0), [](int v) { return v == 0; }));
  NaiveQuads quads(NaiveQuads::Blending::Light);
  const Difference from_reference = difference(draw(quads, view, perspectives, {}), expected);
  EXPECT_LT(from_reference.mean, kMeanTolerance);
  EXPECT_LE(from_reference.largest, kLargestTolerance);
}

TEST_F(NaiveQuadsTest, OfNothingAreBlack) {
  NaiveQuads quads(NaiveQuads::Blending::Light);
  const render::View view{make_camera(160, 120), look_at({0, 0, -4}, {0, 0, 0})};
  EXPECT_EQ(draw(quads, view, {}, {}), hal::Image(160, 120, 3));
}

}  // namespace
}  // namespace lumibox::bench
