#include "render/renderer.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "render/gl_test.h"
#include "render/image_quality.h"
#include "render/proxy_geometry.h"
#include "render/ray_cast.h"
#include "render/reference.h"
#include "support/photo.h"
#include "support/temp_dir.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;
using test::look_at;
using test::make_camera;

double mean_difference(const hal::Image& a, const hal::Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) sum += std::abs(a.data()[i] - b.data()[i]);
  return sum / static_cast<double>(a.size_bytes());
}

int largest_difference(const hal::Image& a, const hal::Image& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) {
    largest = std::max(largest, std::abs(a.data()[i] - b.data()[i]));
  }
  return largest;
}

class RendererTest : public test::GlTest {
 protected:
  void SetUp() override {
    display_ = open_display(160, 120);
    if (display_) renderer_ = std::make_unique<Renderer>();
  }

  hal::Image draw(const View& view, const std::vector<Perspective>& perspectives,
                  const Settings& settings) {
    glBindFramebuffer(GL_FRAMEBUFFER, display_->framebuffer());
    glClearColor(1.0F, 0.0F, 1.0F, 1.0F);  // what is not drawn would be seen
    glClear(GL_COLOR_BUFFER_BIT);
    renderer_->draw(view, perspectives, settings, display_->framebuffer());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return display_->read_back();
  }

  View view_from(const Eigen::Vector3d& center, double roll = 0.0) const {
    return {make_camera(160, 120), look_at(center, Eigen::Vector3d::Zero(), roll)};
  }

  std::unique_ptr<hal::OffscreenDisplay> display_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_F(RendererTest, AgreesWithTheReference) {
  const geometry::Camera cameras[] = {make_camera(160, 120), make_camera(160, 120, true),
                                      test::make_fisheye_camera(160, 120)};
  for (std::size_t lens = 0; lens < std::size(cameras); ++lens) {
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      const auto perspectives = test::random_capture(test::textured_ball(1.0), cameras[lens], 12,
                                                     4.0, 0.2 + 0.25 * seed, seed);
      const View view = view_from({0.4 * seed - 0.5, 0.3, -3.6}, 0.2 * seed);
      for (const int k : {1, 5, 40}) {
        for (const double exponent : {-1.0, 0.0, 2.0}) {  // below zero: small aperture
          Settings settings;
          settings.aperture = exponent < 0.0 ? Aperture::Small : Aperture::Wide;
          settings.exponent = exponent;
          settings.k = k;
          settings.focus = Eigen::Vector3d(0.1, 0.0, 0.2 * seed);
          const hal::Image drawn = draw(view, perspectives, settings);
          const hal::Image expected = render_reference(view, perspectives, settings);
          EXPECT_LT(mean_difference(drawn, expected), 0.5)
              << "lens " << lens << " seed " << seed << " k " << k << " exponent " << exponent;
          EXPECT_LE(largest_difference(drawn, expected), 4);
        }
      }
    }
  }
}

TEST_F(RendererTest, AgreesWithTheReferenceOnAShape) {
  for (const geometry::Camera& camera :
       {make_camera(160, 120), make_camera(160, 120, true), test::make_fisheye_camera(160, 120)}) {
    const auto perspectives =
        test::random_capture(test::textured_ball(1.0), camera, 10, 4.0, 0.4, 3);
    ProxyGeometry proxy({}, Estimating::AtOnce);
    for (const int k : {1, 40}) {
      Settings settings;
      settings.k = k;
      settings.focus = Eigen::Vector3d(0.1, 0.0, 0.2);
      const View view = view_from({0.3, 0.2, -3.6}, 0.2);
      settings = proxy.fit(settings, Geometry::Mesh, view, perspectives);
      EXPECT_LT(mean_difference(draw(view, perspectives, settings),
                                render_reference(view, perspectives, settings)),
                0.5)
          << k;
    }
  }
}

// The horizon of a tilted plane runs through the picture: beyond it nothing may be drawn, though
// the homography maps those pixels into the source too, behind its back.
TEST_F(RendererTest, StopsAtThePlanesHorizon) {
  config::CameraProfile wide_angle = make_camera(160, 120).profile();
  wide_angle.fx = wide_angle.fy = 50.0;
  const Eigen::Vector3d towards(0.985, 0.0, 0.174);  // 80 degrees from the view's axis
  const auto source =
      test::photograph_perspective(0, test::textured_ball(1.0), geometry::Camera(wide_angle),
                                   look_at({0.1, 0.0, 0.0}, Eigen::Vector3d(towards)));
  const View view{make_camera(160, 120), look_at({0, 0, 0}, {0, 0, 1})};
  for (const Aperture aperture : {Aperture::Small, Aperture::Wide}) {
    Settings settings;
    settings.aperture = aperture;
    settings.focus = Eigen::Vector3d(-1.892, 0.0, -0.652);  // behind both, off both axes
    ASSERT_EQ(plan_view(view, {source}, settings).size(), 1U);
    EXPECT_LT(
        mean_difference(draw(view, {source}, settings), render_reference(view, {source}, settings)),
        0.5);
  }
}

TEST_F(RendererTest, HardViewsAgreeWithTheReference) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(160, 120), 6, 4.0, 0.5, 11);
  const geometry::Camera camera = make_camera(160, 120);
  const std::vector<View> views = {
      {camera, perspectives[0].world_from_camera},                 // a recorded view
      {camera, look_at({0, 0, 0}, {0, 0, 1})},                     // at S
      {camera, look_at({0, 0, -0.5}, {0, 0, 0})},                  // inside the sphere
      {camera, look_at({0, 0, 3}, {0, 0, 0})},                     // beyond
      {camera, look_at({0, 0, -4}, {0, 0, -8})},                   // S behind
      {camera, look_at({0, 0, -4}, {4, 0, -4})},                   // planes edge-on
      {camera, look_at({0, 0, -4}, {0, 0, 0}, std::numbers::pi)},  // upside down
      {camera, look_at({0, 0, -400}, {0, 0, 0})},                  // far away
      {camera, look_at({1e-4, 0, -1e-4}, {0, 0, 0})},              // nearly at S
  };
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const Aperture aperture : {Aperture::Small, Aperture::Wide}) {
      Settings settings;
      settings.aperture = aperture;
      EXPECT_LT(mean_difference(draw(views[i], perspectives, settings),
                                render_reference(views[i], perspectives, settings)),
                0.5)
          << "view " << i;
    }
  }
}

TEST_F(RendererTest, AnEmptySetIsBlack) {
  EXPECT_EQ(draw(view_from({0, 0, -4}), {}, {}), hal::Image(160, 120, 3));
}

// More pictures than the GPU keeps, in several sizes, and one that changes under the same id.
TEST_F(RendererTest, PicturesComeAndGo) {
  const test::World world = test::textured_ball(1.0);
  std::vector<Perspective> perspectives;
  for (int i = 0; i < 100; ++i) {
    const geometry::Camera camera = i % 3 == 0 ? make_camera(48, 64) : make_camera(80, 40);
    const double across = 0.02 * i - 1.0;
    const Eigen::Vector3d center(4.0 * std::sin(across), 0.0, -4.0 * std::cos(across));
    perspectives.push_back(
        test::photograph_perspective(i, world, camera, look_at(center, {0, 0, 0})));
  }
  Settings settings;
  settings.k = 8;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < 100; i += 7) {
      const View view{make_camera(160, 120),
                      perspectives[static_cast<std::size_t>(i)].world_from_camera};
      EXPECT_LT(mean_difference(draw(view, perspectives, settings),
                                render_reference(view, perspectives, settings)),
                0.5);
    }
  }
  perspectives[0].photo = testing::photo_of(hal::Image(48, 64, 3));
  perspectives.resize(1);
  EXPECT_EQ(draw(view_from({0, 0, -4}), perspectives, settings), hal::Image(160, 120, 3));
}

// A live picture is one more perspective; on the focus plane all of them agree.
TEST_F(RendererTest, AugmentedApertureFusesTheLivePicture) {
  const test::World world = test::textured_plane(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const geometry::Camera camera = make_camera(160, 120);
  const auto at = [&](int id, double x, double y) {
    return test::photograph_perspective(
        id, world, camera, {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, y, -3.0)});
  };
  const Perspective live = at(-1, 0.05, 0.0);
  const std::vector<Perspective> all = {at(0, 0.2, 0.0), at(1, -0.1, 0.2), at(2, -0.1, -0.2), live};
  const View view{camera, live.world_from_camera};
  const auto fused_at = [&](double depth) {
    const Settings settings = augmented_settings_from({}, {0.0, 0.0, depth});
    return draw(view, all, settings);
  };
  hal::Image middle(160, 120, 1);
  for (int y = 30; y < 90; ++y) std::fill_n(middle.at(40, y), 80, 255);
  EXPECT_GT(psnr(fused_at(0.0), *live.photo->rgb(), &middle), 40.0);
  EXPECT_LT(psnr(fused_at(-1.5), *live.photo->rgb(), &middle), 25.0);
}

/// Every kind of view of some perspectives, by renderers that know nothing of them yet.
std::vector<hal::Image> all_kinds(hal::OffscreenDisplay& display, const View& view,
                                  const std::vector<Perspective>& perspectives) {
  std::vector<hal::Image> pictures;
  for (const Geometry geometry : {Geometry::Plane, Geometry::Mesh}) {
    for (const Aperture aperture : {Aperture::Small, Aperture::Wide}) {
      Settings settings;
      settings.aperture = aperture;
      settings.k = 6;
      ProxyGeometry proxy({}, Estimating::AtOnce);
      settings = proxy.fit(settings, geometry, view, perspectives);
      Renderer renderer;
      renderer.draw(view, perspectives, settings, display.framebuffer());
      pictures.push_back(display.read_back());
      pictures.push_back(render_reference(view, perspectives, settings));
    }
  }
  return pictures;
}

std::vector<Perspective> stored_capture(const testing::TempDir& dir) {
  auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(80, 60), 9, 4.0, 0.3, 2);
  for (Perspective& p : perspectives) {
    p.file = std::to_string(p.id) + ".png";
    testing::store_as_png(*p.photo, dir / p.file);
  }
  return perspectives;
}

TEST_F(RendererTest, ShowsTheSameFromDiskAsFromMemory) {
  const testing::TempDir dir;
  const View view = view_from({0, 0, -4});
  const auto in_memory =
      test::random_capture(test::textured_ball(1.0), make_camera(80, 60), 9, 4.0, 0.3, 2);
  const auto on_disk = stored_capture(dir);
  EXPECT_EQ(on_disk[0].photo->bytes_held(), 0U);
  EXPECT_TRUE(all_kinds(*display_, view, on_disk) == all_kinds(*display_, view, in_memory));
  EXPECT_EQ(on_disk[0].photo->bytes_held(), 0U);
}

// The nearest among them: what is next takes its place.
TEST_F(RendererTest, LeavesOutPicturesThatAreLost) {
  const testing::TempDir dir;
  const View view = view_from({0, 0, -4});
  const auto perspectives = stored_capture(dir);
  const auto nearest = nearest_by_angle(perspectives, {0, 0, -4}, Eigen::Vector3d::Zero());
  std::vector<Perspective> others = perspectives;
  for (const std::size_t rank : {5U, 2U, 0U}) {
    const Perspective& lost = perspectives[nearest[rank].second];
    std::filesystem::remove(dir / lost.file);
    std::erase_if(others, [&](const Perspective& p) { return p.id == lost.id; });
  }
  EXPECT_TRUE(all_kinds(*display_, view, perspectives) == all_kinds(*display_, view, others));
  for (const Perspective& p : perspectives) std::filesystem::remove(dir / p.file);
  for (const hal::Image& nothing : all_kinds(*display_, view, perspectives)) {
    EXPECT_EQ(nothing, hal::Image(160, 120, 3));
  }
}

TEST_F(RendererTest, UploadOfALostPictureDoesNothing) {
  const testing::TempDir dir;
  const auto perspectives = stored_capture(dir);
  std::filesystem::remove(dir / perspectives[0].file);
  renderer_->upload(perspectives[0]);
  renderer_->upload(perspectives[0]);
  EXPECT_TRUE(perspectives[0].photo->fault());
}

TEST_F(RendererTest, UploadAheadChangesNothing) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(80, 60), 5, 4.0, 0.3, 2);
  const View view = view_from({0, 0, -4});
  const hal::Image before = draw(view, perspectives, {});
  Renderer warmed;
  for (const Perspective& perspective : perspectives) warmed.upload(perspective);
  warmed.draw(view, perspectives, {}, display_->framebuffer());
  EXPECT_EQ(display_->read_back(), before);
}

}  // namespace
}  // namespace lumibox::render
