#include "hal/sim/mesh.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <tuple>

#include "hal/sim/noise.h"

namespace lumibox::hal::sim {
namespace {

/// Positions equal to a micrometre are one corner of the surface, seams of the texture included.
using Corner = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
Corner corner_of(const Eigen::Vector3f& p) {
  const auto micrometres = [](float metres) {
    return static_cast<std::int64_t>(std::llround(static_cast<double>(metres) * 1e6));
  };
  return {micrometres(p.x()), micrometres(p.y()), micrometres(p.z())};
}

void add_halves(const Mesh::Rectangle& rectangle, std::vector<Facet>& facets) {
  const std::uint32_t first = rectangle.first_position;
  const std::uint32_t right = first + rectangle.columns;
  const std::uint32_t left_above = first + rectangle.rows * (rectangle.columns + 1);
  const std::uint32_t right_above = left_above + rectangle.columns;
  Facet half{{first, right, right_above}, static_cast<std::int32_t>(rectangle.first_triangle)};
  half.columns = static_cast<std::int32_t>(rectangle.columns);
  half.rows = static_cast<std::int32_t>(rectangle.rows);
  half.triangles_per_cell = 2;
  facets.push_back(half);
  half.corners = {first, right_above, left_above};
  half.upper_left = 1.0f;
  facets.push_back(half);
}

}  // namespace

std::vector<Facet> facets(const Mesh& mesh) {
  std::vector<Facet> result;
  std::uint32_t next = 0;
  const auto add_triangles_before = [&](std::size_t end) {
    for (; next < end; ++next)
      result.push_back({mesh.triangles[next], static_cast<std::int32_t>(next)});
  };
  for (const Mesh::Rectangle& rectangle : mesh.rectangles) {
    add_triangles_before(rectangle.first_triangle);
    add_halves(rectangle, result);
    next += 2 * rectangle.columns * rectangle.rows;
  }
  add_triangles_before(mesh.triangles.size());
  return result;
}

void smooth_normals(Mesh& mesh) {
  std::map<Corner, Eigen::Vector3f> sums;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f& origin = mesh.positions[a];
    const Eigen::Vector3f area =
        (mesh.positions[b] - origin).cross(mesh.positions[c] - origin);  // twice the area
    for (const std::uint32_t i : {a, b, c}) {
      sums.try_emplace(corner_of(mesh.positions[i]), Eigen::Vector3f::Zero()).first->second += area;
    }
  }
  mesh.normals.resize(mesh.positions.size(), Eigen::Vector3f::UnitZ());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto sum = sums.find(corner_of(mesh.positions[i]));
    if (sum != sums.end() && sum->second.squaredNorm() > 0.0f) {
      mesh.normals[i] = sum->second.normalized();
    }
  }
}

void displace(Mesh& mesh, const Displacement& displacement) {
  if (displacement.amplitude_m <= 0.0) return;
  mesh.rectangles.clear();  // no longer flat
  smooth_normals(mesh);
  constexpr int kOctaves = 4;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double height = fractal_noise(mesh.positions[i].cast<double>(), displacement.cell_m,
                                        kOctaves, displacement.seed);
    const double move = displacement.amplitude_m * (2.0 * height - 1.0);
    mesh.positions[i] += static_cast<float>(move) * mesh.normals[i];
  }
  smooth_normals(mesh);
}

std::vector<float> texture_density(const Mesh& mesh) {
  std::vector<float> density;
  density.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    // Edges in an orthonormal frame of the triangle's plane, then the derivative of uv by them.
    const Eigen::Vector3f e1 = mesh.positions[b] - mesh.positions[a];
    const Eigen::Vector3f e2 = mesh.positions[c] - mesh.positions[a];
    const float length = e1.norm();
    const float area = e1.cross(e2).norm();
    if (!(length > 0.0f && area > 0.0f)) {
      density.push_back(1.0f);
      continue;
    }
    Eigen::Matrix2f edges;
    edges << length, e1.dot(e2) / length, 0.0f, area / length;
    Eigen::Matrix2f steps;
    steps << mesh.uv[b] - mesh.uv[a], mesh.uv[c] - mesh.uv[a];
    const Eigen::Matrix2f jacobian = steps * edges.inverse();
    const float half_trace = 0.5f * jacobian.squaredNorm();
    const float determinant = jacobian.determinant();
    const float discriminant = std::max(0.0f, half_trace * half_trace - determinant * determinant);
    density.push_back(std::sqrt(half_trace + std::sqrt(discriminant)));  // largest singular value
  }
  return density;
}

}  // namespace lumibox::hal::sim
