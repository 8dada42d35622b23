#include "render/tiles.h"

#include <algorithm>

namespace lumibox::render {
namespace {

constexpr int kTile = 32;         // pixels; smaller ones cost more to find than they save
constexpr float kMargin = 0.05F;  // pixels of the source, for the shader's rounding

/// What a picture does in a tile.
enum class Cover { None, Part, All };

/// A view cut into squares; the last in a row or column may be cut off.
struct Grid {
  int size;  ///< of a square, pixels
  int width;
  int height;
  int across;
  int down;

  Grid(const View& view, int tile)
      : size(tile),
        width(view.camera.width()),
        height(view.camera.height()),
        across((width + tile - 1) / tile),
        down((height + tile - 1) / tile) {}
};

/// Where the squares begin and end along a side of the view, `per_tile` steps for each. Never
/// outside the view: there something may lie behind a camera.
std::vector<double> steps(int tiles, int size, int length, int per_tile) {
  std::vector<double> places = {0.0};
  for (int tile = 1; tile <= tiles; ++tile) {
    const double begin = places.back();
    const double end = std::min(tile * size, length);
    for (int i = 1; i <= per_tile; ++i) places.push_back(begin + (end - begin) * i / per_tile);
  }
  return places;
}

/// Where the corners of the tiles lie in a layer's picture, and if its lens distorts, the middles
/// of their sides too.
class Samples {
 public:
  Samples(const LayerUniforms& layer, const geometry::Camera& camera, const Grid& grid,
          bool distortion)
      : layer_(layer),
        per_tile_(distortion ? 2 : 1),
        stride_(static_cast<std::size_t>(per_tile_ * grid.across) + 1) {
    const std::vector<double> columns = steps(grid.across, grid.size, grid.width, per_tile_);
    for (const double down : steps(grid.down, grid.size, grid.height, per_tile_)) {
      for (const double across : columns) {
        const auto x = static_cast<float>(across - 0.5 * grid.width);
        const auto y = static_cast<float>(down - 0.5 * grid.height);
        const auto source = [&](std::size_t i) {
          return layer.from_x[i] * x + layer.from_y[i] * y + layer.from_1[i];
        };
        const Eigen::Vector2f at(source(0) / source(2), source(1) / source(2));
        places_.emplace_back(distortion ? camera.distort(at.cast<double>()).cast<float>() : at);
        beyond_fold_.push_back(distortion && at.squaredNorm() >= layer.lens[1]);
      }
    }
  }

  Cover cover(int column, int row) const {
    // Lines map onto lines: what is in a tile lies between its corners. A lens bends its sides, but
    // by less than half a pixel of the view between their middles and ends.
    Eigen::Array2f least = place(column, row, 0, 0);
    Eigen::Array2f most = least;
    for (int y = 0; y <= per_tile_; ++y) {
      for (int x = 0; x <= per_tile_; ++x) {
        least = least.min(place(column, row, x, y));
        most = most.max(place(column, row, x, y));
      }
    }
    const Eigen::Array2f last(layer_.picture[0], layer_.picture[1]);
    const float feather = 1.0F / layer_.picture[2];
    if (any_beyond_fold(column, row)) return Cover::Part;
    if ((most < -kMargin).any() || (least > last + kMargin).any()) return Cover::None;
    const bool inside =
        (least > feather + kMargin).all() && (most < last - feather - kMargin).all();
    return inside ? Cover::All : Cover::Part;
  }

 private:
  std::size_t index(int column, int row, int x, int y) const {
    return static_cast<std::size_t>(per_tile_ * row + y) * stride_ +
           static_cast<std::size_t>(per_tile_ * column + x);
  }
  const Eigen::Array2f& place(int column, int row, int x, int y) const {
    return places_[index(column, row, x, y)];
  }

  /// A radius is largest in a corner.
  bool any_beyond_fold(int column, int row) const {
    const int last = per_tile_;
    return beyond_fold_[index(column, row, 0, 0)] || beyond_fold_[index(column, row, last, 0)] ||
           beyond_fold_[index(column, row, 0, last)] ||
           beyond_fold_[index(column, row, last, last)];
  }

  const LayerUniforms& layer_;
  int per_tile_;  ///< steps along each side
  std::size_t stride_;
  std::vector<Eigen::Array2f> places_;
  std::vector<bool> beyond_fold_;
};

/// The layers of one tile.
struct List {
  std::vector<std::uint8_t> layers;
  bool hidden_behind = false;  ///< the last is opaque all over the tile

  bool alone() const { return layers.size() == 1 && hidden_behind; }
};

std::vector<List> make_lists(const Grid& grid, const LayerData& data) {
  std::vector<List> lists(static_cast<std::size_t>(grid.across) *
                          static_cast<std::size_t>(grid.down));
  for (std::size_t i = 0; i < data.layers.size(); ++i) {
    const Samples samples(data.layers[i], *data.cameras[i], grid, data.kind.distortion);
    const bool hides = data.layers[i].from_y[3] >= 1.0F;
    auto list = lists.begin();
    for (int row = 0; row < grid.down; ++row) {
      for (int column = 0; column < grid.across; ++column, ++list) {
        const Cover cover = list->hidden_behind ? Cover::None : samples.cover(column, row);
        if (cover == Cover::None) continue;
        list->layers.push_back(static_cast<std::uint8_t>(i));
        list->hidden_behind = hides && cover == Cover::All;
      }
    }
  }
  return lists;
}

}  // namespace

Tiles tiles_of(const View& view, const LayerData& data) {
  Tiles tiles;
  tiles.size = kTile;
  do {
    const Grid grid(view, tiles.size);
    tiles.alone.clear();
    tiles.mixed.clear();
    tiles.lists.clear();
    std::size_t next = 0;
    const std::vector<List> lists = make_lists(grid, data);
    for (int row = 0; row < grid.down; ++row) {
      for (int column = 0; column < grid.across; ++column) {
        const List& list = lists[next++];
        if (list.alone()) {
          tiles.alone.push_back({column, row, list.layers.front()});
          continue;
        }
        tiles.mixed.push_back({column, row, static_cast<std::int32_t>(tiles.lists.size())});
        tiles.lists.insert(tiles.lists.end(), list.layers.begin(), list.layers.end());
        tiles.lists.push_back(Tiles::kEnd);
      }
    }
    tiles.size *= 2;
  } while (tiles.lists.size() > Tiles::kMostEntries);
  tiles.size /= 2;
  return tiles;
}

}  // namespace lumibox::render
