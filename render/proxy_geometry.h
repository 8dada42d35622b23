#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

struct DepthMap;

/// What pictures are projected onto.
enum class Geometry {
  Plane,  ///< a plane per perspective through S (thesis 3.1)
  Focal,  ///< the same through the depth at which a plane serves all of the view best
  Mesh,   ///< the scene's shape, told by the pictures themselves
};

/// Makes settings fit a view, with what is known of the scene. Depth maps are estimated where they
/// are first needed, a fifth of a second each, and kept.
class ProxyGeometry {
 public:
  /// `points`: of the scene, in world; may be empty.
  explicit ProxyGeometry(std::vector<Eigen::Vector3d> points);
  ~ProxyGeometry();
  ProxyGeometry(const ProxyGeometry&) = delete;
  ProxyGeometry& operator=(const ProxyGeometry&) = delete;

  /// Focal: `settings.focus` moves to the optical axis, to the harmonic mean of the depths of the
  /// nearest and the farthest point seen (Chai et al., "Plenoptic sampling", SIGGRAPH 2000);
  /// without points it stays. Mesh: settings.shape and fewer pictures. Plane: nothing changes.
  Settings fit(Settings settings, Geometry geometry, const View& view,
               const std::vector<lightfield::Perspective>& perspectives);

 private:
  struct Entry;
  Eigen::Vector3d focal_point(const View& view, const Eigen::Vector3d& otherwise) const;
  std::shared_ptr<const DepthGrid> shape_of(
      const View& view, const std::vector<lightfield::Perspective>& perspectives,
      const Eigen::Vector3d& focus);
  std::shared_ptr<const DepthMap> map_of(const std::vector<lightfield::Perspective>& perspectives,
                                         std::size_t index, const Eigen::Vector3d& focus);

  std::vector<Eigen::Vector3d> points_;
  std::vector<Entry> entries_;  ///< used last come last
};

}  // namespace lumibox::render
