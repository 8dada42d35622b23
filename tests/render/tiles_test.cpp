#include "render/tiles.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "render/blending.h"
#include "render/ray_cast.h"

namespace lumibox::render {
namespace {

using test::look_at;
using test::make_camera;

enum class Lens { Pinhole, Distorting, Fisheye };

const std::vector<lightfield::Perspective>& capture(Lens lens, std::uint32_t seed) {
  static std::map<std::pair<Lens, std::uint32_t>, std::vector<lightfield::Perspective>> captures;
  auto& known = captures[{lens, seed}];
  if (known.empty()) {
    const geometry::Camera camera = lens == Lens::Fisheye
                                        ? test::make_fisheye_camera(64, 48)
                                        : make_camera(64, 48, lens == Lens::Distorting);
    known = test::random_capture(test::textured_ball(1.0), camera, 12, 4.0, 0.5, seed);
  }
  return known;
}

struct Planned {
  View view;
  LayerData data;
};

Planned plan(double across, double roll, int width, int height, std::uint32_t seed,
             Lens lens = Lens::Pinhole) {
  const std::vector<lightfield::Perspective>& perspectives = capture(lens, seed);
  const View view{make_camera(width, height), look_at({across, 0.3, -3.7}, {0.2, 0, 0}, roll)};
  const std::vector<Layer> layers = plan_view(view, perspectives, {});
  const std::vector<LayerSlots> slots(layers.size());
  return {view, layer_data(view, perspectives, {}, layers, slots)};
}

/// How much a layer's picture is faded at a fragment; 0 where it shows nothing.
double fade_at(const Planned& planned, std::size_t i, int x, int y) {
  const LayerUniforms& layer = planned.data.layers[i];
  const Eigen::Vector2d place = Eigen::Vector2d(x + 0.5, y + 0.5) - middle_of(planned.view);
  Eigen::Vector3d source;
  for (std::size_t row = 0; row < 3; ++row) {
    source[static_cast<Eigen::Index>(row)] = static_cast<double>(layer.from_x[row]) * place.x() +
                                             static_cast<double>(layer.from_y[row]) * place.y() +
                                             static_cast<double>(layer.from_1[row]);
  }
  const double feather_px = 1.0 / static_cast<double>(layer.picture[2]);
  const geometry::Camera& camera = *planned.data.cameras[i];
  const auto fade = [&](const Eigen::Vector2d& pixel) {
    return feather(pixel, camera.width(), camera.height(), feather_px);
  };
  if (!planned.data.kind.distortion) return fade(source.hnormalized());
  const auto pixel = camera.project(source);
  return pixel ? fade(*pixel) : 0.0;
}

/// The lists of all tiles, by column and row.
class Lists {
 public:
  explicit Lists(const Tiles& tiles) : size_(tiles.size) {
    for (const Tiles::Block& block : tiles.alone) put(block, {block.shows});
    for (const Tiles::Block& block : tiles.mixed) {
      const auto begin = tiles.lists.begin() + block.shows;
      put(block, {begin, std::find(begin, tiles.lists.end(), Tiles::kEnd)});
    }
  }

  /// Of the tile that a fragment lies in.
  const std::vector<int>& at(int x, int y) const { return lists_.at({x / size_, y / size_}); }

 private:
  void put(const Tiles::Block& block, const std::vector<int>& list) {
    for (int row = block.row; row < block.row + block.rows; ++row) {
      for (int column = block.column; column < block.column + block.columns; ++column) {
        EXPECT_TRUE(lists_.try_emplace({column, row}, list).second) << "drawn twice";
      }
    }
  }

  int size_;
  std::map<std::pair<int, int>, std::vector<int>> lists_;
};

/// A place where a layer shows something and is not in the tile's list; empty if there is none.
std::string left_out(const Planned& planned, int step = 5) {
  const Lists lists(tiles_of(planned.view, planned.data));
  for (int y = 0; y < planned.view.camera.height(); y += step) {
    for (int x = 0; x < planned.view.camera.width(); x += step) {
      const std::vector<int>& list = lists.at(x, y);
      if (!std::ranges::is_sorted(list)) return fmt::format("unsorted at {}, {}", x, y);
      double transmittance = 1.0;
      for (std::size_t i = 0; i < planned.data.layers.size() && transmittance > 0.0; ++i) {
        const double alpha =
            static_cast<double>(planned.data.layers[i].from_y[3]) * fade_at(planned, i, x, y);
        if (alpha > 0.0 && std::ranges::count(list, static_cast<int>(i)) != 1) {
          return fmt::format("layer {} at {}, {}", i, x, y);
        }
        transmittance *= 1.0 - alpha;
      }
    }
  }
  return {};
}

/// What is drawn as a picture alone must be opaque all over, since nothing is put behind it: a
/// place where it is not; empty if there is none.
std::string not_opaque(const Planned& planned) {
  const Tiles tiles = tiles_of(planned.view, planned.data);
  for (const Tiles::Block& block : tiles.alone) {
    const auto layer = static_cast<std::size_t>(block.shows);
    const int right =
        std::min(planned.view.camera.width(), (block.column + block.columns) * tiles.size);
    const int top = std::min(planned.view.camera.height(), (block.row + block.rows) * tiles.size);
    for (int y = block.row * tiles.size; y < top; y += 3) {
      for (int x = block.column * tiles.size; x < right; x += 3) {
        const double alpha = static_cast<double>(planned.data.layers[layer].from_y[3]) *
                             fade_at(planned, layer, x, y);
        if (alpha < 1.0) return fmt::format("{} at {}, {}", alpha, x, y);
      }
    }
  }
  return {};
}

/// One picture, seen from where it was taken.
Planned plan_one(const geometry::Camera& source, const geometry::Camera& camera) {
  lightfield::Perspective perspective;
  perspective.camera = std::make_shared<const geometry::Camera>(source);
  perspective.photo = std::make_shared<lightfield::Photo>(
      std::make_shared<const hal::Image>(source.width(), source.height(), 3));
  Settings settings;
  settings.focus = Eigen::Vector3d::UnitZ();
  const View view{camera, geometry::Pose{}};
  const std::vector<Layer> layers = plan_view(view, {perspective}, settings);
  return {view, layer_data(view, {perspective}, settings, layers, {LayerSlots{}})};
}

Planned arbitrary_plan(Lens lens) {
  const double across = 0.01 * *rc::gen::inRange(-150, 150);
  const double roll = 0.01 * *rc::gen::inRange(-300, 300);
  return plan(across, roll, *rc::gen::inRange(1, 200), *rc::gen::inRange(1, 150),
              *rc::gen::inRange<std::uint32_t>(0, 20), lens);
}

RC_GTEST_PROP(TilesProperties, NothingThatIsSeenIsLeftOut, ()) {
  const Planned planned =
      arbitrary_plan(*rc::gen::element(Lens::Pinhole, Lens::Distorting, Lens::Fisheye));
  RC_PRE(planned.data.kind.tiles());
  RC_ASSERT(left_out(planned).empty());
}

RC_GTEST_PROP(TilesProperties, APictureAloneIsOpaque, ()) {
  const Planned planned =
      arbitrary_plan(*rc::gen::element(Lens::Pinhole, Lens::Distorting, Lens::Fisheye));
  RC_PRE(planned.data.kind.tiles());
  RC_ASSERT(not_opaque(planned).empty());
}

// Its corners outside the view may lie behind a camera, where there is no telling what they map to.
TEST(Tiles, ATileLargerThanTheViewEndsWithIt) {
  for (const Lens lens : {Lens::Pinhole, Lens::Distorting, Lens::Fisheye}) {
    for (const double across : {-1.5, -0.7, 0.7, 1.5}) {
      const Planned planned = plan(across, -1.58, 5, 4, 0, lens);
      if (!planned.data.kind.tiles()) continue;
      EXPECT_EQ(left_out(planned), "");
    }
  }
}

// Where a tile is a large part of the picture a lens bends its sides most; the border's farthest
// point lies between two samples here.
TEST(Tiles, ALensBendsTheSidesOfATile) {
  config::CameraProfile profile = make_camera(640, 480).profile();
  profile.k1 = 0.3;
  config::CameraProfile wide = make_camera(96, 96).profile();
  wide.fx = wide.fy = 30.0;
  wide.cx = 56.0;
  for (double shift = 0.0; shift < 32.0; shift += 0.25) {  // of the border from the tiles
    wide.cy = 32.0 + shift;
    const Planned planned = plan_one(geometry::Camera(profile), geometry::Camera(wide));
    ASSERT_TRUE(planned.data.kind.tiles());
    ASSERT_EQ(left_out(planned, 1), "") << shift;
    ASSERT_EQ(not_opaque(planned), "") << shift;
  }
}

// Beyond the fold a lens' formula comes back into the picture.
TEST(Tiles, NothingIsBeyondTheFold) {
  config::CameraProfile profile = make_camera(640, 480).profile();
  profile.k1 = -0.28;
  config::CameraProfile wide = make_camera(640, 480).profile();
  wide.fx = wide.fy = 100.0;
  const Planned planned = plan_one(geometry::Camera(profile), geometry::Camera(wide));
  ASSERT_TRUE(planned.data.kind.tiles());
  EXPECT_EQ(left_out(planned), "");
  EXPECT_EQ(not_opaque(planned), "");
}

// Without it the tests above would pass on lists of everything.
TEST(Tiles, MostNeedFewLayers) {
  for (const Lens lens : {Lens::Pinhole, Lens::Distorting, Lens::Fisheye}) {
    const Planned planned = plan(0.0, 0.0, 320, 240, 3, lens);
    ASSERT_TRUE(planned.data.kind.tiles());
    const Tiles tiles = tiles_of(planned.view, planned.data);
    const Lists lists(tiles);
    std::size_t layers = 0;
    std::size_t count = 0;
    for (int y = 0; y < 240; y += tiles.size) {
      for (int x = 0; x < 320; x += tiles.size, ++count) layers += lists.at(x, y).size();
    }
    EXPECT_LT(layers, planned.data.layers.size() * count * 4 / 5);
    EXPECT_EQ(lists.at(160, 120).size(), 1U) << "the nearest is opaque in the middle";
    EXPECT_LT(tiles.alone.size(), 4U) << "all of the middle shows the same";
  }
}

TEST(Tiles, ListsFitAUniformBlockWhateverTheView) {
  Planned planned = plan(0.0, 0.0, 4000, 3000, 3);
  const LayerData twelve = planned.data;
  while (planned.data.layers.size() + twelve.layers.size() <= kMaxLayers) {
    planned.data.layers.insert(planned.data.layers.end(), twelve.layers.begin(),
                               twelve.layers.end());
    planned.data.cameras.insert(planned.data.cameras.end(), twelve.cameras.begin(),
                                twelve.cameras.end());
  }
  for (LayerUniforms& layer : planned.data.layers) layer.from_y[3] = 0.4F;  // nothing ends a list
  const Tiles tiles = tiles_of(planned.view, planned.data);
  EXPECT_LE(tiles.lists.size(), Tiles::kMostEntries);
  EXPECT_FALSE(Lists(tiles).at(2000, 1500).empty());
}

}  // namespace
}  // namespace lumibox::render
