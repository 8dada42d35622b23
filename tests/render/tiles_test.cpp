#include "render/tiles.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/blending.h"
#include "render/ray_cast.h"

namespace lumibox::render {
namespace {

using test::look_at;
using test::make_camera;

struct Planned {
  View view;
  LayerData data;
};

Planned plan(double across, double roll, int width, int height, std::uint32_t seed) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(64, 48), 12, 4.0, 0.5, seed);
  const View view{make_camera(width, height), look_at({across, 0.3, -3.7}, {0.2, 0, 0}, roll)};
  const std::vector<Layer> layers = plan_view(view, perspectives, {});
  const std::vector<LayerSlots> slots(layers.size());
  return {view, layer_data(view, perspectives, {}, layers, slots)};
}

/// Where a fragment lies in a layer's picture, and how much that is faded there.
double fade_at(const Planned& planned, const LayerUniforms& layer, int x, int y) {
  const Eigen::Vector2d place = Eigen::Vector2d(x + 0.5, y + 0.5) - middle_of(planned.view);
  Eigen::Vector3d source;
  for (std::size_t i = 0; i < 3; ++i) {
    source[static_cast<Eigen::Index>(i)] = static_cast<double>(layer.from_x[i]) * place.x() +
                                           static_cast<double>(layer.from_y[i]) * place.y() +
                                           static_cast<double>(layer.from_1[i]);
  }
  return feather(source.hnormalized(), 64, 48, 1.0 / static_cast<double>(layer.picture[2]));
}

std::vector<int> list_at(const Tiles& tiles, int x, int y) {
  const auto tile = static_cast<std::size_t>((y / tiles.size) * tiles.across + x / tiles.size);
  std::vector<int> list;
  for (std::size_t j = tile * tiles.row; tiles.lists[j] != Tiles::kEnd; ++j) {
    list.push_back(tiles.lists[j]);
  }
  return list;
}

RC_GTEST_PROP(TilesProperties, NothingThatIsSeenIsLeftOut, ()) {
  const double across = 0.01 * *rc::gen::inRange(-150, 150);
  const double roll = 0.01 * *rc::gen::inRange(-300, 300);
  const Planned planned = plan(across, roll, *rc::gen::inRange(1, 200), *rc::gen::inRange(1, 150),
                               *rc::gen::inRange<std::uint32_t>(0, 20));
  RC_PRE(planned.data.kind.tiles());
  const Tiles tiles = tiles_of(planned.view, planned.data);
  const auto& layers = planned.data.layers;
  for (int y = 0; y < planned.view.camera.height(); y += 5) {
    for (int x = 0; x < planned.view.camera.width(); x += 5) {
      const std::vector<int> list = list_at(tiles, x, y);
      RC_ASSERT(std::ranges::is_sorted(list));
      double transmittance = 1.0;
      for (std::size_t i = 0; i < layers.size() && transmittance > 0.0; ++i) {
        const double alpha =
            static_cast<double>(layers[i].from_y[3]) * fade_at(planned, layers[i], x, y);
        if (alpha > 0.0) RC_ASSERT(std::ranges::count(list, static_cast<int>(i)) == 1);
        transmittance *= 1.0 - alpha;
      }
    }
  }
}

// Without it the test above would pass on lists of everything.
TEST(Tiles, MostNeedFewLayers) {
  const Planned planned = plan(0.0, 0.0, 320, 240, 3);
  ASSERT_TRUE(planned.data.kind.tiles());
  const Tiles tiles = tiles_of(planned.view, planned.data);
  std::size_t entries = 0;
  for (const std::uint8_t entry : tiles.lists) entries += entry == Tiles::kEnd ? 0 : 1;
  const auto all = planned.data.layers.size() * static_cast<std::size_t>(tiles.across * tiles.down);
  EXPECT_LT(entries, all * 4 / 5);
  EXPECT_EQ(list_at(tiles, 160, 120).size(), 1U) << "the nearest is opaque in the middle";
}

TEST(Tiles, FitATextureWhateverTheView) {
  const Planned planned = plan(0.0, 0.0, 4000, 3000, 3);
  const Tiles tiles = tiles_of(planned.view, planned.data);
  EXPECT_LE(tiles.across * tiles.down, 2048);
  EXPECT_GE(tiles.across * tiles.size, 4000);
  EXPECT_GE(tiles.down * tiles.size, 3000);
}

}  // namespace
}  // namespace lumibox::render
