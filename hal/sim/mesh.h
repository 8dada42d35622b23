#pragma once

#include <Eigen/Core>
#include <algorithm>
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

  /// A flat rectangle cut into cells so that baked light has somewhere to live: its positions row
  /// by row, its triangles two to a cell.
  struct Rectangle {
    std::uint32_t first_position;
    std::uint32_t first_triangle;
    std::uint32_t columns;
    std::uint32_t rows;
  };
  std::vector<Rectangle> rectangles;  ///< in the order of their triangles
};

/// What rays meet: one triangle of a mesh, or half a rectangle, as its cells would only cost time.
struct Facet {
  std::array<std::uint32_t, 3> corners;  ///< positions
  std::int32_t triangle;                 ///< the first one
  std::int32_t columns = 1;              ///< cells
  std::int32_t rows = 1;
  std::int32_t triangles_per_cell = 1;  ///< 1: the triangle alone
  float upper_left = 0.0f;              ///< 1: the half beyond the diagonal from the first position

  /// Where in which triangle a hit lies; u and v as Embree has them.
  struct Spot {
    std::size_t triangle;
    float u;
    float v;
  };
  Spot spot(float u, float v) const;
};
std::vector<Facet> facets(const Mesh& mesh);

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

// Without a branch, which a ray in two would take by surprise.
inline Facet::Spot Facet::spot(float u, float v) const {
  const float x = (u + (1.0f - upper_left) * v) * static_cast<float>(columns);
  const float y = (v + upper_left * u) * static_cast<float>(rows);
  const int column = std::min(static_cast<int>(x), columns - 1);
  const int row = std::min(static_cast<int>(y), rows - 1);
  const float in_x = x - static_cast<float>(column);
  const float in_y = y - static_cast<float>(row);
  const int second = static_cast<int>(in_x < in_y) & (triangles_per_cell - 1);
  const int cell = row * columns + column;
  const auto share = static_cast<float>(second);
  return {static_cast<std::size_t>(triangle + cell * triangles_per_cell + second),
          in_x - (1.0f - share) * in_y, in_y - share * in_x};
}

}  // namespace lumibox::hal::sim
