#include "render/tiles.h"

#include <algorithm>
#include <cmath>

namespace lumibox::render {
namespace {

constexpr int kTile = 32;             // pixels; smaller ones cost more to find than they save
constexpr double kMaxTiles = 1024.0;  // rows of a texture that every OpenGL ES 3 device has
constexpr float kMargin = 0.05F;      // pixels of the source, for the shader's rounding

/// What a picture does in a tile.
enum class Cover { None, Part, All };

/// Corners of the tiles in a layer's picture. A plane before both cameras maps lines onto lines, so
/// what is in a tile lies between its corners.
class Corners {
 public:
  Corners(const LayerUniforms& layer, const Tiles& tiles, const Eigen::Vector2d& middle)
      : layer_(layer), stride_(static_cast<std::size_t>(tiles.across) + 1) {
    for (int row = 0; row <= tiles.down; ++row) {
      for (int column = 0; column <= tiles.across; ++column) {
        const auto x = static_cast<float>(column * tiles.size - middle.x());
        const auto y = static_cast<float>(row * tiles.size - middle.y());
        const auto source = [&](std::size_t i) {
          return layer.from_x[i] * x + layer.from_y[i] * y + layer.from_1[i];
        };
        corners_.emplace_back(source(0) / source(2), source(1) / source(2));
      }
    }
  }

  Cover cover(int column, int row) const {
    const std::size_t i =
        static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
    const Eigen::Array2f least =
        corners_[i].min(corners_[i + 1]).min(corners_[i + stride_].min(corners_[i + stride_ + 1]));
    const Eigen::Array2f most =
        corners_[i].max(corners_[i + 1]).max(corners_[i + stride_].max(corners_[i + stride_ + 1]));
    const Eigen::Array2f last(layer_.picture[0], layer_.picture[1]);
    const float feather = 1.0F / layer_.picture[2];
    if ((most < -kMargin).any() || (least > last + kMargin).any()) return Cover::None;
    const bool inside =
        (least > feather + kMargin).all() && (most < last - feather - kMargin).all();
    return inside ? Cover::All : Cover::Part;
  }

 private:
  const LayerUniforms& layer_;
  std::size_t stride_;
  std::vector<Eigen::Array2f> corners_;
};

}  // namespace

Tiles tiles_of(const View& view, const LayerData& data) {
  Tiles tiles;
  const double pixels = static_cast<double>(view.camera.width()) * view.camera.height();
  tiles.size = std::max(kTile, static_cast<int>(std::ceil(std::sqrt(4.0 * pixels / kMaxTiles))));
  tiles.across = (view.camera.width() + tiles.size - 1) / tiles.size;
  tiles.down = (view.camera.height() + tiles.size - 1) / tiles.size;
  tiles.row = data.layers.size() + 1;
  const auto count = static_cast<std::size_t>(tiles.across * tiles.down);
  tiles.lists.assign(count * tiles.row, Tiles::kEnd);
  std::vector<std::size_t> lengths(count, 0);
  std::vector<bool> opaque(count, false);
  for (std::size_t layer = 0; layer < data.layers.size(); ++layer) {
    const Corners corners(data.layers[layer], tiles, middle_of(view));
    const bool hides = data.kind.small_aperture && data.layers[layer].from_y[3] >= 1.0F;
    std::size_t tile = 0;
    for (int row = 0; row < tiles.down; ++row) {
      for (int column = 0; column < tiles.across; ++column, ++tile) {
        const Cover cover = opaque[tile] ? Cover::None : corners.cover(column, row);
        if (cover == Cover::None) continue;
        tiles.lists[tile * tiles.row + lengths[tile]++] = static_cast<std::uint8_t>(layer);
        if (hides && cover == Cover::All) opaque[tile] = true;
      }
    }
  }
  return tiles;
}

}  // namespace lumibox::render
