#include "render/picture_supply.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "geometry/rotation.h"
#include "render/gl_test.h"
#include "render/proxy_geometry.h"
#include "render/ray_cast.h"
#include "render/renderer.h"
#include "support/photo.h"
#include "support/temp_dir.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr std::size_t kTinyBytes = 16 * 12 * 4;  // of a picture on the GPU

class PictureCacheTest : public test::GlTest {
 protected:
  void SetUp() override { display_ = open_display(32, 24); }

  static std::shared_ptr<const lightfield::Photo> tiny() {
    return testing::photo_of(hal::Image(16, 12, 3));
  }

  std::unique_ptr<hal::OffscreenDisplay> display_;
};

TEST_F(PictureCacheTest, KeepsWhatFitsIntoTheBudget) {
  PictureCache cache(4 * kTinyBytes + 1);
  cache.begin_view(1, 16, 12);
  EXPECT_EQ(cache.slots(), 4U);
  cache.begin_view(1, 16, 24);
  EXPECT_EQ(cache.slots(), 2U);
}

TEST_F(PictureCacheTest, WhatOneViewNeedsGoesBeforeTheBudget) {
  PictureCache cache(2 * kTinyBytes);
  cache.begin_view(3, 16, 12);
  std::vector<std::shared_ptr<const lightfield::Photo>> view = {tiny(), tiny(), tiny()};
  for (const auto& picture : view) EXPECT_TRUE(cache.slot_of(picture));
  for (const auto& picture : view) EXPECT_TRUE(cache.holds(picture));
}

TEST_F(PictureCacheTest, OverwritesThatWhichNoViewHasUsedForLongest) {
  PictureCache cache(3 * kTinyBytes);
  const std::vector<std::shared_ptr<const lightfield::Photo>> pictures = {tiny(), tiny(), tiny(),
                                                                          tiny()};
  for (int i = 0; i < 3; ++i) {
    cache.begin_view(1, 16, 12);
    cache.slot_of(pictures[static_cast<std::size_t>(i)]);
  }
  cache.begin_view(1, 16, 12);
  cache.slot_of(pictures[0]);  // near again
  cache.begin_view(1, 16, 12);
  cache.slot_of(pictures[3]);  // newly recorded
  EXPECT_TRUE(cache.holds(pictures[0]));
  EXPECT_FALSE(cache.holds(pictures[1]));
  EXPECT_TRUE(cache.holds(pictures[2]));
  EXPECT_TRUE(cache.holds(pictures[3]));
}

TEST_F(PictureCacheTest, OverwritesFirstWhatIsNoMore) {
  PictureCache cache(2 * kTinyBytes);
  const auto stays = tiny();
  cache.begin_view(2, 16, 12);
  cache.slot_of(stays);
  cache.begin_view(2, 16, 12);
  cache.slot_of(tiny());  // wiped at once
  cache.begin_view(2, 16, 12);
  cache.slot_of(tiny());
  EXPECT_TRUE(cache.holds(stays));
}

/// A row of perspectives a degree apart on a circle, their pictures in files.
class PictureSupplyTest : public test::GlTest {
 protected:
  void SetUp() override {
    display_ = open_display(160, 120);
    options_.k = 6;
  }

  void record(int count, int width = 16, int height = 12) {
    for (int i = 0; i < count; ++i) {
      Perspective p;
      p.id = i;
      p.world_from_camera = pose_at(i);
      p.camera = std::make_shared<const geometry::Camera>(test::make_camera(width, height));
      p.photo = testing::photo_of(hal::Image(width, height, 3));
      testing::store_as_png(*p.photo, dir_ / (std::to_string(i) + ".png"));
      perspectives_.push_back(p);
    }
  }

  static geometry::Pose pose_at(double degrees) {
    const double angle = degrees * std::acos(-1.0) / 180.0;
    return test::look_at({4.0 * std::sin(angle), 0.0, -4.0 * std::cos(angle)}, {0, 0, 0});
  }

  View view_at(double degrees) const { return {test::make_camera(160, 120), pose_at(degrees)}; }

  SuppliedView supply(PictureSupply& supply, double degrees) {
    return supply.supply(view_at(degrees), perspectives_, settings());
  }

  Settings settings() const { return settings_from(options_, Aperture::Wide, {0, 0, 0}); }

  static std::vector<int> ids(const SuppliedView& supplied) {
    std::vector<int> ids;
    for (const Layer& layer : supplied.layers) ids.push_back(static_cast<int>(layer.perspective));
    return ids;
  }

  /// Indices of what is on the GPU.
  std::vector<int> held(const PictureSupply& supply) const {
    std::vector<int> held;
    for (const Perspective& p : perspectives_) {
      if (supply.cache().holds(p.photo)) held.push_back(p.id);
    }
    return held;
  }

  void read_all() {
    while (ahead_.read_next()) {
    }
  }

  testing::TempDir dir_;
  std::unique_ptr<hal::OffscreenDisplay> display_;
  config::Render options_;
  std::vector<Perspective> perspectives_;
  ReadAhead ahead_;
};

TEST_F(PictureSupplyTest, ReadsAHandfulItselfAndShowsThoseUntilTheOthersAreRead) {
  record(20);
  PictureSupply pictures(options_, &ahead_);
  EXPECT_EQ(ids(supply(pictures, 4.9)), (std::vector<int>{5, 4, 6, 3}));
  EXPECT_EQ(ids(supply(pictures, 4.9)), (std::vector<int>{5, 4, 6, 3})) << "nobody has read";
  EXPECT_TRUE(ahead_.read_next());
  EXPECT_EQ(ids(supply(pictures, 4.9)), (std::vector<int>{5, 4, 6, 3, 7})) << "the nearest first";
}

TEST_F(PictureSupplyTest, InTheEndItIsTheSameViewAsWithAllAtOnce) {
  record(20);
  PictureSupply pictures(options_, &ahead_);
  supply(pictures, 4.9);
  read_all();
  const SuppliedView some = supply(pictures, 4.9);
  PictureSupply at_once(options_, nullptr);
  const SuppliedView all = supply(at_once, 4.9);
  EXPECT_EQ(ids(some), ids(all));
  EXPECT_EQ(some.layers.size(), 6U);
  EXPECT_EQ(some.planned, all.planned);
  for (std::size_t i = 0; i < all.layers.size(); ++i) {
    EXPECT_EQ(some.layers[i].weight, all.layers[i].weight);
  }
}

// The nearest eleven beyond are kept ready; where the view goes nobody has to wait.
TEST_F(PictureSupplyTest, ReadsAroundTheViewWhatItWillShowNext) {
  record(40);
  PictureSupply pictures(options_, &ahead_);
  for (int i = 0; i < 5; ++i) {
    supply(pictures, 19.9);
    read_all();
  }
  EXPECT_EQ(held(pictures).front(), 14);
  EXPECT_EQ(held(pictures).back(), 25);
  EXPECT_FALSE(ahead_.read_next()) << "and then there is peace";
  EXPECT_EQ(ids(supply(pictures, 22.9)), (std::vector<int>{23, 22, 24, 21, 25, 20}));
}

TEST_F(PictureSupplyTest, TheNextNearestTakeThePlaceOfThoseThatAreNotReadYetButNoneFromAfar) {
  record(40);
  PictureSupply pictures(options_, &ahead_);
  supply(pictures, 4.9);
  read_all();
  supply(pictures, 4.9);
  read_all();
  supply(pictures, 4.9);
  EXPECT_EQ(held(pictures).back(), 11);
  EXPECT_EQ(ids(supply(pictures, 12.9)), (std::vector<int>{13, 12, 11, 10, 9, 8}));
  EXPECT_EQ(ids(supply(pictures, 35.9)), (std::vector<int>{36, 35, 37, 34})) << "after a jump";
}

TEST_F(PictureSupplyTest, UploadsNoMoreThanTwoLargePicturesPerView) {
  options_.k = 12;
  record(12, 640, 480);
  PictureSupply pictures(options_, &ahead_);
  supply(pictures, 4.9);
  EXPECT_EQ(held(pictures).size(), 4U) << "the handful";
  for (const std::size_t expected : {6U, 8U, 10U, 12U}) {
    read_all();
    supply(pictures, 4.9);
    EXPECT_EQ(held(pictures).size(), expected);
  }
}

TEST_F(PictureSupplyTest, PicturesThatAreLostAreLeftOut) {
  record(20);
  for (const int lost : {4, 5, 7}) std::filesystem::remove(dir_ / (std::to_string(lost) + ".png"));
  PictureSupply pictures(options_, &ahead_);
  EXPECT_EQ(ids(supply(pictures, 4.9)), (std::vector<int>{6, 3, 2}));
  for (int i = 0; i < 3; ++i) {
    supply(pictures, 4.9);
    read_all();
  }
  EXPECT_EQ(ids(supply(pictures, 4.9)), (std::vector<int>{6, 3, 2, 8, 1, 9}));
  for (const auto& entry : std::filesystem::directory_iterator(dir_.path())) {
    std::filesystem::remove(entry.path());
  }
  PictureSupply nothing(options_, &ahead_);
  EXPECT_TRUE(supply(nothing, 15.0).layers.empty());
}

std::size_t programs() {
  std::size_t count = 0;
  for (GLuint name = 1; name < 1000; ++name) count += glIsProgram(name) == GL_TRUE ? 1U : 0U;
  return count;
}

// Views from all sides, also beside the subject, where planes have a horizon.
TEST_F(PictureSupplyTest, NoViewOfOneCameraNeedsAShaderThatPrepareHasNotCompiled) {
  for (const bool distorted : {false, true}) {
    const auto perspectives = test::random_capture(
        test::textured_ball(1.0), test::make_camera(80, 60, distorted), 6, 4.0, 1.0, 2);
    Renderer renderer;
    while (renderer.prepare_next(view_at(0.0), perspectives.front().camera,
                                 display_->framebuffer())) {
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    const std::size_t prepared = programs();
    ProxyGeometry proxy({}, Estimating::AtOnce);
    for (const double yaw : {0.0, 0.5, 1.2, 3.0}) {
      View view = view_at(10.0);
      view.world_from_camera.rotation =
          view.world_from_camera.rotation * geometry::exp_so3({0.0, yaw, 0.0});
      for (const Aperture aperture : {Aperture::Small, Aperture::Wide}) {
        for (const Geometry geometry : {Geometry::Plane, Geometry::Mesh}) {
          const Settings plain = settings_from(options_, aperture, {0, 0, 0});
          renderer.draw(view, perspectives, proxy.fit(plain, geometry, view, perspectives),
                        display_->framebuffer());
        }
      }
    }
    EXPECT_EQ(programs(), prepared);
  }
}

}  // namespace
}  // namespace lumibox::render
