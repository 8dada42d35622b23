#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lightfield/perspective.h"
#include "render/depth_maps.h"
#include "render/view.h"

namespace lumibox::render {

/// What pictures are projected onto.
enum class Geometry {
  Plane,  ///< a plane per perspective through S (thesis 3.1)
  Focal,  ///< the same through the depth at which a plane serves all of the view best
  Mesh,   ///< the scene's shape, told by the pictures themselves
};

/// Of "plane", "focal" and "mesh".
Geometry geometry_named(const std::string& name);

/// Most pictures that are blended on a shape: the far ones hardly count.
inline constexpr std::size_t kPicturesOfView = 8;

/// Makes settings fit a view, with what is known of the scene.
class ProxyGeometry {
 public:
  /// `points`: of the scene, in world; may be empty.
  ProxyGeometry(std::vector<Eigen::Vector3d> points, Estimating estimating);

  /// Focal: `settings.focus` moves to the optical axis, to the harmonic mean of the depths of the
  /// nearest and the farthest point seen (Chai et al., "Plenoptic sampling", SIGGRAPH 2000);
  /// without points it stays. Mesh: settings.shape and fewer pictures. Plane: nothing changes.
  /// Where only some of the perspectives are drawn, `counted` has their indices: the shape is told
  /// by the depth maps of those (which themselves come from all).
  Settings fit(Settings settings, Geometry geometry, const View& view,
               const std::vector<lightfield::Perspective>& perspectives,
               const std::optional<std::vector<std::size_t>>& counted = std::nullopt);

  /// True if nothing that was needed so far is still to come.
  bool is_complete() { return maps_.complete(); }

 private:
  Eigen::Vector3d focal_point(const View& view, const Eigen::Vector3d& otherwise) const;
  std::shared_ptr<const Shape> shape_of(const View& view,
                                        const std::vector<lightfield::Perspective>& perspectives,
                                        const Eigen::Vector3d& focus,
                                        const std::optional<std::vector<std::size_t>>& counted);

  std::vector<Eigen::Vector3d> points_;
  DepthMaps maps_;
};

}  // namespace lumibox::render
