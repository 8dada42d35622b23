#include "render/depth_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/sampling.h"

namespace lumibox::render {
namespace {

constexpr double kMaxCells = 33000.0;
constexpr double kLeastCell = 4.0;  // pixels of the view; what the maps resolve
constexpr double kNearer = 3.0;     // power of the inverse depth by which nearer samples weigh more
constexpr float kEnough = 0.05F;    // weight of samples at which a corner needs no others

/// Sums over samples at the corners of a grid, and the coarser grids that fill its holes.
struct Level {
  int columns;
  int rows;
  std::vector<float> sum;     // of weight times inverse depth
  std::vector<float> weight;  // of all samples

  Level(int columns_, int rows_)
      : columns(columns_),
        rows(rows_),
        sum(static_cast<std::size_t>(columns_ * rows_)),
        weight(static_cast<std::size_t>(columns_ * rows_)) {}

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * columns + x); }

  void add(int x, int y, float value, float w) {
    if (x < 0 || y < 0 || x >= columns || y >= rows) return;
    sum[index(x, y)] += w * value;
    weight[index(x, y)] += w;
  }
};

/// Each sample's surface point, seen from the view.
void splat(const View& view, const DepthGrid::Source& source, double cell, double unit,
           Level& level) {
  const DepthMap& map = *source.map;
  const config::CameraProfile& from = map.camera.profile();
  const config::CameraProfile& to = view.camera.profile();
  const geometry::Pose view_from_map = view.world_from_camera.inverse() * source.world_from_map;
  const Eigen::Matrix3f rotation = view_from_map.matrix3().cast<float>();
  const Eigen::Vector3f shift = view_from_map.translation.cast<float>();
  std::size_t i = 0;
  for (int y = 0; y < map.camera.height(); ++y) {
    for (int x = 0; x < map.camera.width(); ++x, ++i) {
      const float rho = map.inverse_depth(i);
      const Eigen::Vector3f ray(static_cast<float>((x - from.cx) / from.fx),
                                static_cast<float>((y - from.cy) / from.fy), 1.0F);
      const Eigen::Vector3f point = rotation * ray + rho * shift;  // times its inverse depth
      if (!(point.z() > 0.0F)) continue;
      const float seen = rho / point.z();
      const auto column = static_cast<float>((to.fx * point.x() / point.z() + to.cx) / cell);
      const auto row = static_cast<float>((to.fy * point.y() / point.z() + to.cy) / cell);
      if (!(column > -1.0F && row > -1.0F && column < static_cast<float>(level.columns) &&
            row < static_cast<float>(level.rows))) {
        continue;
      }
      const auto nearness = static_cast<float>(std::pow(seen * unit, kNearer));
      const float weight = static_cast<float>(source.weight) * map.confidence(i) * nearness;
      const int left = static_cast<int>(std::floor(column));
      const int top = static_cast<int>(std::floor(row));
      const float a = column - static_cast<float>(left);
      const float b = row - static_cast<float>(top);
      level.add(left, top, seen, weight * (1.0F - a) * (1.0F - b));
      level.add(left + 1, top, seen, weight * a * (1.0F - b));
      level.add(left, top + 1, seen, weight * (1.0F - a) * b);
      level.add(left + 1, top + 1, seen, weight * a * b);
    }
  }
}

/// How much a corner's own samples count against those around it.
float trust(float weight) {
  return std::min(1.0F, weight / kEnough);
}

Level coarser(const Level& fine) {
  Level coarse((fine.columns + 1) / 2, (fine.rows + 1) / 2);
  for (int y = 0; y < fine.rows; ++y) {
    for (int x = 0; x < fine.columns; ++x) {
      const std::size_t i = fine.index(x, y);
      if (fine.weight[i] <= 0.0F) continue;
      coarse.add(x / 2, y / 2, fine.sum[i] / fine.weight[i], trust(fine.weight[i]));
    }
  }
  return coarse;
}

/// Values at all corners of the finest level: its own where it has samples, else those of the
/// coarser levels (Gortler et al., "The Lumigraph", SIGGRAPH 1996, section 3.4: pull and push).
std::vector<float> filled(Level finest, float fallback) {
  std::vector<Level> levels{std::move(finest)};
  while (levels.back().columns > 1 || levels.back().rows > 1) {
    levels.push_back(coarser(levels.back()));
  }
  const Level& top = levels.back();
  std::vector<float> values{top.weight[0] > 0.0F ? top.sum[0] / top.weight[0] : fallback};
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    const Level& level = levels[l];
    const Level& above = levels[l + 1];
    std::vector<float> finer(level.sum.size());
    for (int y = 0; y < level.rows; ++y) {
      for (int x = 0; x < level.columns; ++x) {
        const std::size_t i = level.index(x, y);
        const float around = sample_bilinear(values, above.columns, above.rows,
                                             0.5F * (static_cast<float>(x) - 0.5F),
                                             0.5F * (static_cast<float>(y) - 0.5F));
        const float own = trust(level.weight[i]);
        finer[i] =
            own > 0.0F ? own * level.sum[i] / level.weight[i] + (1.0F - own) * around : around;
      }
    }
    values = std::move(finer);
  }
  return values;
}

}  // namespace

DepthGrid::DepthGrid(const View& view, const std::vector<Source>& sources, double fallback) {
  const double width = view.camera.width();
  const double height = view.camera.height();
  cell_ = std::max(kLeastCell, std::ceil(std::sqrt(width * height / kMaxCells)));
  columns_ = static_cast<int>(std::ceil((width - 1.0) / cell_)) + 1;
  rows_ = static_cast<int>(std::ceil((height - 1.0) / cell_)) + 1;
  Level finest(columns_, rows_);
  for (const Source& source : sources) splat(view, source, cell_, 1.0 / fallback, finest);
  inverse_depths_ = filled(std::move(finest), static_cast<float>(fallback));
}

double DepthGrid::largest() const {
  return static_cast<double>(*std::ranges::max_element(inverse_depths_));
}

double DepthGrid::at(double u, double v) const {
  return static_cast<double>(sample_bilinear(inverse_depths_, columns_, rows_,
                                             static_cast<float>(u / cell_),
                                             static_cast<float>(v / cell_)));
}

}  // namespace lumibox::render
