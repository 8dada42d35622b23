#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Triangles in an object's own frame. Texture coordinates are metres on the surface, as nearly as
/// the shape can be unrolled.
struct Mesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;                 ///< unit, outwards; one per position
  std::vector<Eigen::Vector2f> uv;                      ///< one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
};

/// The mesh of any shape but a file; `spec` has been checked by the scene reader.
Mesh make_shape(const ObjectSpec& spec);

/// A Wavefront OBJ file (v, vt, vn, f with polygons, negative indices; other lines are skipped).
/// Missing normals are computed, missing texture coordinates are x and y. Throws
/// config::InputError with file and line.
Mesh read_obj(const std::filesystem::path& file);

/// Replaces the normals by area-weighted means over positions that coincide.
void smooth_normals(Mesh& mesh);

/// Moves each position along its normal by fractal noise, the same for positions that coincide.
void displace(Mesh& mesh, const Displacement& displacement);

/// Largest stretch of the texture over each triangle: texture coordinates per metre.
std::vector<float> texture_density(const Mesh& mesh);

}  // namespace lumibox::hal::sim
