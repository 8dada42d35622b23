#include "render/tiles.h"

#include <algorithm>

namespace lumibox::render {
namespace {

constexpr int kTile = 32;         // pixels; smaller ones cost more to find than they save
constexpr float kMargin = 0.05F;  // pixels of the source, for the shader's rounding

/// What a picture does in a tile.
enum class Cover { None, Part, All };

/// A view cut into squares.
struct Grid {
  int size;  ///< of a square, pixels
  int across;
  int down;
  Eigen::Vector2d middle;  ///< of the view

  Grid(const View& view, int tile)
      : size(tile),
        across((view.camera.width() + tile - 1) / tile),
        down((view.camera.height() + tile - 1) / tile),
        middle(middle_of(view)) {}
};

/// Where the corners of the tiles lie in a layer's picture, and if its lens distorts, the middles
/// of their sides too.
class Samples {
 public:
  Samples(const LayerUniforms& layer, const geometry::Camera& camera, const Grid& grid,
          bool distortion)
      : layer_(layer),
        per_tile_(distortion ? 2 : 1),
        stride_(static_cast<std::size_t>(per_tile_ * grid.across) + 1) {
    const double step = static_cast<double>(grid.size) / per_tile_;
    for (int row = 0; row <= per_tile_ * grid.down; ++row) {
      for (int column = 0; column <= per_tile_ * grid.across; ++column) {
        const auto x = static_cast<float>(column * step - grid.middle.x());
        const auto y = static_cast<float>(row * step - grid.middle.y());
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
    // Lines map onto lines but for the lens: what is in a tile lies between its corners.
    Eigen::Array2f least = place(column, row, 0, 0);
    Eigen::Array2f most = least;
    for (int y = 0; y <= per_tile_; ++y) {
      for (int x = 0; x <= per_tile_; ++x) {
        least = least.min(place(column, row, x, y));
        most = most.max(place(column, row, x, y));
      }
    }
    const Eigen::Array2f last(layer_.picture[0], layer_.picture[1]);
    const Eigen::Array2f margin = kMargin + bend(column, row);
    const float feather = 1.0F / layer_.picture[2];
    if (any_beyond_fold(column, row)) return Cover::Part;
    if ((most < -margin).any() || (least > last + margin).any()) return Cover::None;
    const bool inside = (least > feather + margin).all() && (most < last - feather - margin).all();
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

  /// How far a lens bends a tile's sides between their ends. Between an end and the middle it is a
  /// quarter of that.
  Eigen::Array2f bend(int column, int row) const {
    Eigen::Array2f most = Eigen::Array2f::Zero();
    if (per_tile_ == 1) return most;
    for (int i = 0; i <= 2; ++i) {
      const auto at = [&](int x, int y) { return place(column, row, x, y); };
      most = most.max((at(1, i) - 0.5F * (at(0, i) + at(2, i))).abs());
      most = most.max((at(i, 1) - 0.5F * (at(i, 0) + at(i, 2))).abs());
    }
    return most;
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
