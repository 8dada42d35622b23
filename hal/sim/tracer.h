#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "hal/sim/camera_rays.h"
#include "hal/sim/color.h"
#include "hal/sim/scene_spec.h"
#include "hal/sim/world.h"

namespace lumibox::hal::sim {

/// Rays through the exact camera model into a world: one per pixel, more only where the scene has
/// traced shadows, mirrors or glass.
class Tracer {
 public:
  struct RayCount {
    std::int64_t camera = 0;
    std::int64_t secondary = 0;
  };

  /// `world` and `spec` outlive the tracer.
  Tracer(const World& world, const SceneSpec& spec, const geometry::Camera& camera);

  /// Fills the rows [begin, end) of a picture of the camera's size.
  void trace_rows(const geometry::Pose& world_from_camera, int begin, int end, LinearImage& image);

  const RayCount& rays() const { return rays_; }

 private:
  /// A ray that widens as a pixel does (Amanatides, SIGGRAPH 1984).
  struct Cone {
    Eigen::Vector3f origin;
    Eigen::Vector3f direction;  ///< any length; distances count in it
    float width = 0.0f;         ///< metres at the origin
    float spread = 0.0f;        ///< metres per unit of distance
    int surfaces = 0;           ///< mirrors and glass met so far
  };

  /// Points of surfaces without optics: what light they get, and what paints them (nothing: white).
  struct MattePoints {
    std::array<Float4, RayPacket::kSize> light;
    Texture::Places places;
    std::array<const Texture*, RayPacket::kSize> texture{};
  };

  void shade_tile(const CameraRays::Tile& tile, const RayPacket& packet,
                  const Eigen::Vector3f& origin, LinearImage& image);
  bool is_matte(unsigned geometry_id) const;
  Color radiance(const Cone& cone);
  Color shade(const Cone& cone, const RTCHit& hit, float distance);
  Color matte(const Cone& cone, const RTCHit& hit, float distance, float width);
  /// Fills lane `i`; `width` is the pixel's on the surface, slant included.
  void meet(const Cone& cone, const RTCHit& hit, float distance, float width, std::size_t i,
            MattePoints& points);
  /// Multiplies the light by the textures.
  static void paint(MattePoints& points);
  Color traced_light(const Eigen::Vector3f& point, const Eigen::Vector3f& normal);
  Color reflected(const Cone& cone, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                  float width, float curvature);
  Color through_glass(const Cone& cone, const Body& body, const Eigen::Vector3f& point,
                      const Eigen::Vector3f& normal, float width, float curvature);

  const World& world_;
  Color background_;
  std::vector<LightSpec> traced_lights_;
  int reflection_depth_ = 0;
  int refraction_depth_ = 0;
  int width_;
  float pixel_spread_;
  CameraRays camera_rays_;
  RayCount rays_;
};

}  // namespace lumibox::hal::sim
