#include "render/tiles.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
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
  if (!planned.data.kind.distortion) return feather(source.hnormalized(), 64, 48, feather_px);
  const auto pixel = planned.data.cameras[i]->project(source);
  return pixel ? feather(*pixel, 64, 48, feather_px) : 0.0;
}

/// Layers of the tile that a fragment lies in.
std::vector<int> list_at(const Tiles& tiles, int x, int y) {
  const auto covers = [&](const Tiles::Tile& tile) {
    return tile.column == x / tiles.size && tile.row == y / tiles.size;
  };
  const auto alone = std::ranges::find_if(tiles.alone, covers);
  const auto mixed = std::ranges::find_if(tiles.mixed, covers);
  if (alone != tiles.alone.end()) {
    EXPECT_EQ(mixed, tiles.mixed.end()) << "drawn twice";
    return {alone->shows};
  }
  if (mixed == tiles.mixed.end()) {
    ADD_FAILURE() << "no tile at " << x << ", " << y;
    return {};
  }
  const auto begin = tiles.lists.begin() + mixed->shows;
  return {begin, std::find(begin, tiles.lists.end(), Tiles::kEnd)};
}

void check_nothing_seen_is_left_out(const Planned& planned) {
  const Tiles tiles = tiles_of(planned.view, planned.data);
  for (int y = 0; y < planned.view.camera.height(); y += 5) {
    for (int x = 0; x < planned.view.camera.width(); x += 5) {
      const std::vector<int> list = list_at(tiles, x, y);
      RC_ASSERT(std::ranges::is_sorted(list));
      double transmittance = 1.0;
      for (std::size_t i = 0; i < planned.data.layers.size() && transmittance > 0.0; ++i) {
        const double alpha =
            static_cast<double>(planned.data.layers[i].from_y[3]) * fade_at(planned, i, x, y);
        if (alpha > 0.0) RC_ASSERT(std::ranges::count(list, static_cast<int>(i)) == 1);
        transmittance *= 1.0 - alpha;
      }
    }
  }
}

/// What is drawn as a picture alone must be opaque all over, since nothing is put behind it.
void check_alone_is_opaque(const Planned& planned) {
  const Tiles tiles = tiles_of(planned.view, planned.data);
  for (const Tiles::Tile& tile : tiles.alone) {
    const auto layer = static_cast<std::size_t>(tile.shows);
    for (int y = tile.row * tiles.size; y < (tile.row + 1) * tiles.size; y += 3) {
      for (int x = tile.column * tiles.size; x < (tile.column + 1) * tiles.size; x += 3) {
        if (x >= planned.view.camera.width() || y >= planned.view.camera.height()) continue;
        RC_ASSERT(fade_at(planned, layer, x, y) == 1.0);
      }
    }
    RC_ASSERT(planned.data.layers[layer].from_y[3] == 1.0F);
  }
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
  check_nothing_seen_is_left_out(planned);
}

RC_GTEST_PROP(TilesProperties, APictureAloneIsOpaque, ()) {
  const Planned planned =
      arbitrary_plan(*rc::gen::element(Lens::Pinhole, Lens::Distorting, Lens::Fisheye));
  RC_PRE(planned.data.kind.tiles());
  check_alone_is_opaque(planned);
}

// Without it the tests above would pass on lists of everything.
TEST(Tiles, MostNeedFewLayers) {
  for (const Lens lens : {Lens::Pinhole, Lens::Distorting, Lens::Fisheye}) {
    const Planned planned = plan(0.0, 0.0, 320, 240, 3, lens);
    ASSERT_TRUE(planned.data.kind.tiles());
    const Tiles tiles = tiles_of(planned.view, planned.data);
    std::size_t layers = 0;
    for (const Tiles::Tile& tile : tiles.mixed) {
      layers += list_at(tiles, tile.column * tiles.size, tile.row * tiles.size).size();
    }
    const std::size_t count = tiles.mixed.size() + tiles.alone.size();
    EXPECT_LT(layers, planned.data.layers.size() * count * 4 / 5);
    EXPECT_EQ(list_at(tiles, 160, 120).size(), 1U) << "the nearest is opaque in the middle";
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
  EXPECT_GT(list_at(tiles, 3999, 2999).size() + list_at(tiles, 0, 0).size(), 0U);
}

}  // namespace
}  // namespace lumibox::render
