#include "render/tiles.h"

#include <algorithm>
#include <optional>

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

/// Where the squares begin and end along a side of the view, from its middle, `per_tile` steps for
/// each. Never outside the view: there something may lie behind a camera.
std::vector<float> steps(int tiles, int size, int length, int per_tile) {
  const double middle = 0.5 * length;
  std::vector<float> places = {static_cast<float>(-middle)};
  for (int tile = 0; tile < tiles; ++tile) {
    const double begin = tile * size;
    const double end = std::min((tile + 1) * size, length);
    for (int i = 1; i <= per_tile; ++i) {
      places.push_back(static_cast<float>(begin + (end - begin) * i / per_tile - middle));
    }
  }
  return places;
}

/// Where the corners of the tiles lie in a layer's picture, and if its lens distorts, the middles
/// of their sides too. They are found when first asked for: most tiles are hidden from most layers.
class Samples {
 public:
  Samples(const LayerUniforms& layer, const geometry::Camera& camera, const Grid& grid,
          bool distortion)
      : layer_(layer),
        camera_(camera),
        distortion_(distortion),
        per_tile_(distortion ? 2 : 1),
        across_(steps(grid.across, grid.size, grid.width, per_tile_)),
        down_(steps(grid.down, grid.size, grid.height, per_tile_)),
        samples_(across_.size() * down_.size()) {}

  Cover cover(int column, int row) {
    // Lines map onto lines: what is in a tile lies between its corners. A lens bends its sides, but
    // by less than half a pixel of the view between their middles and ends.
    Eigen::Array2f least = sample(column, row, 0, 0).place;
    Eigen::Array2f most = least;
    bool beyond_fold = false;  // a radius is largest in a corner
    for (int y = 0; y <= per_tile_; ++y) {
      for (int x = 0; x <= per_tile_; ++x) {
        const Sample& at = sample(column, row, x, y);
        least = least.min(at.place);
        most = most.max(at.place);
        beyond_fold = beyond_fold || at.beyond_fold;
      }
    }
    if (beyond_fold) return Cover::Part;
    const Eigen::Array2f last(layer_.picture[0], layer_.picture[1]);
    const float feather = 1.0F / layer_.picture[2];
    if ((most < -kMargin).any() || (least > last + kMargin).any()) return Cover::None;
    const bool inside =
        (least > feather + kMargin).all() && (most < last - feather - kMargin).all();
    return inside ? Cover::All : Cover::Part;
  }

 private:
  struct Sample {
    Eigen::Array2f place;  ///< in the picture
    bool beyond_fold = false;
    bool known = false;
  };

  const Sample& sample(int column, int row, int x, int y) {
    const auto right = static_cast<std::size_t>(per_tile_ * column + x);
    const auto up = static_cast<std::size_t>(per_tile_ * row + y);
    Sample& known = samples_[up * across_.size() + right];
    if (!known.known) known = find(across_[right], down_[up]);
    return known;
  }

  Sample find(float x, float y) const {
    const auto source = [&](std::size_t i) {
      return layer_.from_x[i] * x + layer_.from_y[i] * y + layer_.from_1[i];
    };
    const Eigen::Vector2f at = Eigen::Vector2f(source(0), source(1)) / source(2);
    if (!distortion_) return {at, false, true};
    return {camera_.distort(at.cast<double>()).cast<float>(), at.squaredNorm() >= layer_.lens[1],
            true};
  }

  const LayerUniforms& layer_;
  const geometry::Camera& camera_;
  bool distortion_;
  int per_tile_;               ///< steps along each side
  std::vector<float> across_;  ///< places from the view's middle
  std::vector<float> down_;
  std::vector<Sample> samples_;
};

/// The layers of one tile.
struct List {
  std::vector<std::uint8_t> layers;
  bool hidden_behind = false;  ///< the last is opaque all over the tile

  bool alone() const { return layers.size() == 1 && hidden_behind; }
  bool operator==(const List&) const = default;
};

std::vector<List> make_lists(const Grid& grid, const LayerData& data) {
  std::vector<List> lists(static_cast<std::size_t>(grid.across) *
                          static_cast<std::size_t>(grid.down));
  for (std::size_t i = 0; i < data.layers.size(); ++i) {
    Samples samples(data.layers[i], *data.cameras[i], grid, data.kind.distortion);
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

/// Makes blocks of the tiles: fewer and larger ones have fewer edges to be drawn.
class Blocks {
 public:
  Blocks(const Grid& grid, const std::vector<List>& lists)
      : grid_(grid), lists_(lists), taken_(lists.size(), false) {}

  /// The largest block of equal tiles from this one on, to the right and then up; none if another
  /// block has it.
  std::optional<Tiles::Block> take(int column, int row) {
    if (taken_[index(column, row)]) return std::nullopt;
    Tiles::Block block{column, row};
    while (block.column + block.columns < grid_.across &&
           goes_with(block, block.column + block.columns, row)) {
      ++block.columns;
    }
    while (block.row + block.rows < grid_.down && row_goes_with(block, block.row + block.rows)) {
      ++block.rows;
    }
    for (int y = row; y < row + block.rows; ++y) {
      for (int x = column; x < column + block.columns; ++x) taken_[index(x, y)] = true;
    }
    return block;
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.across) +
           static_cast<std::size_t>(column);
  }
  bool goes_with(const Tiles::Block& block, int column, int row) const {
    return !taken_[index(column, row)] &&
           lists_[index(column, row)] == lists_[index(block.column, block.row)];
  }
  bool row_goes_with(const Tiles::Block& block, int row) const {
    for (int column = block.column; column < block.column + block.columns; ++column) {
      if (!goes_with(block, column, row)) return false;
    }
    return true;
  }

  const Grid& grid_;
  const std::vector<List>& lists_;
  std::vector<bool> taken_;
};

Tiles in_tiles_of(int size, const View& view, const LayerData& data) {
  const Grid grid(view, size);
  const std::vector<List> lists = make_lists(grid, data);
  Blocks blocks(grid, lists);
  Tiles tiles;
  tiles.size = size;
  auto list = lists.begin();
  for (int row = 0; row < grid.down; ++row) {
    for (int column = 0; column < grid.across; ++column, ++list) {
      std::optional<Tiles::Block> block = blocks.take(column, row);
      if (!block) continue;
      if (list->alone()) {
        block->shows = list->layers.front();
        tiles.alone.push_back(*block);
        continue;
      }
      block->shows = static_cast<std::int32_t>(tiles.lists.size());
      tiles.mixed.push_back(*block);
      tiles.lists.insert(tiles.lists.end(), list->layers.begin(), list->layers.end());
      tiles.lists.push_back(Tiles::kEnd);
    }
  }
  return tiles;
}

}  // namespace

Tiles tiles_of(const View& view, const LayerData& data) {
  Tiles tiles = in_tiles_of(kTile, view, data);
  while (tiles.lists.size() > Tiles::kMostEntries) {
    tiles = in_tiles_of(2 * tiles.size, view, data);
  }
  return tiles;
}

}  // namespace lumibox::render
