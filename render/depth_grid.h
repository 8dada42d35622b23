#pragma once

#include <memory>
#include <vector>

#include "render/depth_map.h"
#include "render/view.h"

namespace lumibox::render {

/// How far away the scene is at the pixels of a view: inverse depths along its optical axis at the
/// corners of square cells, bilinear between them. A mesh that moves with the view and has no
/// holes: what no depth map shows lies as far as what is around it. It changes continuously with
/// the view.
class DepthGrid {
 public:
  /// From the depth maps of perspectives near the view, each with its share in the whole.
  struct Source {
    std::shared_ptr<const DepthMap> map;
    geometry::Pose world_from_map;
    double weight = 1.0;  ///< positive; 0 for one that is about to leave
  };

  /// `fallback` is the inverse depth where there is no source at all.
  DepthGrid(const View& view, const std::vector<Source>& sources, double fallback);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double cell() const { return cell_; }  ///< pixels of the view
  const std::vector<float>& inverse_depths() const { return inverse_depths_; }  ///< row by row

  double largest() const;  ///< inverse depth

  /// At a pixel within the view.
  double at(double u, double v) const;

 private:
  int columns_;
  int rows_;
  double cell_;
  std::vector<float> inverse_depths_;
};

/// What is known of the scene's shape for one view of some perspectives.
struct Shape {
  DepthGrid grid;
  /// Of the perspectives, by index: what hides the shape from them. Null where there is none.
  std::vector<std::shared_ptr<const DepthMap>> maps;
};

}  // namespace lumibox::render
