#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "render/view.h"

namespace lumibox::render {

/// `Layer` of light_field.frag, std140; what each number means stands there.
struct LayerUniforms {
  std::array<float, 4> from_x, from_y, from_1;
  std::array<float, 4> beyond;
  std::array<float, 4> picture;
  std::array<float, 4> intrinsics;
  std::array<float, 4> distortion;
  std::array<float, 4> lens;

  bool same_camera(const LayerUniforms& other) const;
};
static_assert(sizeof(LayerUniforms) * kMaxLayers <= 16384, "the least that ES 3 promises");

/// What light_field.frag is compiled for: the words that are defined in it.
struct Kind {
  bool small_aperture = false;
  bool shape = false;
  bool distortion = false;
  bool horizon = false;
  bool one_camera = false;

  static constexpr std::size_t kCount = 32;
  /// Whether the shader goes by tiles (tiles.h): where it is known which part of the view each
  /// layer covers, and most parts do not need them all.
  bool tiles() const { return small_aperture && !horizon; }

  std::size_t index() const {
    return (small_aperture ? 16U : 0U) + (shape ? 8U : 0U) + (distortion ? 4U : 0U) +
           (horizon ? 2U : 0U) + (one_camera ? 1U : 0U);
  }
};

/// Where a layer's picture and depth map are on the GPU.
struct LayerSlots {
  int picture = 0;
  int map = -1;              ///< below 0: there is none
  double largest_map = 1.0;  ///< inverse depth that the map's largest sample stands for
};

/// The middle of a view as gl_FragCoord: where the shader counts places from.
Eigen::Vector2d middle_of(const View& view);

/// Length in which the shader has inverse depths, so that half precision serves.
double unit_of(const View& view, const Settings& settings);

/// Data of the layers of a view, and the least that the shader must be compiled for to draw them.
struct LayerData {
  std::vector<LayerUniforms> layers;
  std::vector<std::shared_ptr<const geometry::Camera>> cameras;  ///< of the layers
  Kind kind;
};
LayerData layer_data(const View& view, const std::vector<lightfield::Perspective>& perspectives,
                     const Settings& settings, const std::vector<Layer>& layers,
                     const std::vector<LayerSlots>& slots);

}  // namespace lumibox::render
