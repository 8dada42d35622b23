#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <vector>

#include "geometry/pose.h"
#include "hal/sim/camera_rays.h"
#include "hal/sim/float4.h"
#include "hal/sim/mesh.h"
#include "hal/sim/motion.h"
#include "hal/sim/scene_spec.h"
#include "hal/sim/texture.h"

namespace lumibox::hal::sim {

/// What shading needs of a triangle, in one line of cache. Values at a hit are those at the first
/// corner plus the hit's u times the step to the second plus its v times the step to the third.
struct alignas(64) SurfaceTriangle {
  /// Irradiance / pi of all lights whose shadows are not traced (red, green, blue), and the texture
  /// coordinate u, in tiles: at the first corner, and the two steps.
  std::array<Float4, 3> light_and_u;
  std::array<float, 3> v;  ///< the other texture coordinate
  float tiles_per_metre;   ///< the texture's largest stretch
};

/// One object: what Embree does not know about it.
struct Body {
  std::vector<Eigen::Vector3f> positions;  ///< at rest; only until the light is baked
  std::vector<SurfaceTriangle> surface;    ///< per triangle
  std::vector<Eigen::Vector3f> normals;    ///< of the vertices, where the scene file put the object
  Eigen::Matrix3f world_from_rest = Eigen::Matrix3f::Identity();  ///< turns normals with a mover
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Facet> facets;               ///< by Embree's primitive id
  std::shared_ptr<const Texture> texture;  ///< none: white
  float mirror = 0.0f;
  float glass_ior = 0.0f;  ///< 0: not glass
  Color glass_tint{1.0f, 1.0f, 1.0f};

  /// Balls of glass or mirror are exact spheres, not triangles: optics magnifies facets.
  bool is_exact_sphere = false;
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0.0f;

  bool is_optical() const { return mirror > 0.0f || glass_ior > 0.0f; }
};

/// The scene's geometry in Embree, its materials and its light, at one time.
class World {
 public:
  explicit World(const SceneSpec& spec);

  /// Nearest hits of rays that begin together, of one ray; whether anything is in the way.
  void intersect8(RayPacket& packet) const;
  void intersect1(RTCRayHit& ray) const;
  bool occluded1(RTCRay& ray) const;

  const Body& body(unsigned geometry_id) const { return *bodies_[geometry_id]; }

  /// Unit normal in the world of a hit on a triangle or an exact sphere.
  Eigen::Vector3f normal(const RTCHit& hit, const Eigen::Vector3f& point) const;

  bool moves() const { return !movers_.empty(); }

  /// Moves what moves to where it is at a time and refits; false if nothing had to be done.
  bool move_to(double time_s);

  /// Who renders a world that moves holds this meanwhile.
  std::mutex& mutex() { return mutex_; }

 private:
  template <typename T>
  using Owned = std::unique_ptr<std::remove_pointer_t<T>, void (*)(T)>;

  /// Something that changes place: its vertices as the scene file put them, and how they move.
  struct Mover {
    unsigned geometry_id;
    std::vector<Eigen::Vector3f> rest;
    std::shared_ptr<const Motion> motion;
    geometry::Pose world_from_rest;
  };

  void add_object(const ObjectSpec& spec, std::shared_ptr<const Motion> motion,
                  const std::vector<TextureSpec>& textures);
  void add_exact_sphere(const ObjectSpec& spec);
  void add_mesh(const ObjectSpec& spec, std::shared_ptr<const Motion> motion,
                const Eigen::Vector2d& tile_m);
  void bake(Body& body, const std::vector<LightSpec>& lights) const;

  Owned<RTCDevice> device_;
  Owned<RTCScene> fixed_;
  Owned<RTCScene> moving_;  ///< apart, so that refitting it does not touch what stands still
  std::vector<std::unique_ptr<Body>> bodies_;  ///< by geometry id; Embree keeps their addresses
  std::map<std::string, std::shared_ptr<const Texture>> textures_;
  std::vector<Mover> movers_;
  std::mutex mutex_;
};

}  // namespace lumibox::hal::sim
