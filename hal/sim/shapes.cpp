#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "hal/sim/mesh.h"

namespace lumibox::hal::sim {
namespace {

constexpr float kTwoPi = 2.0f * std::numbers::pi_v<float>;

/// Adds a grid of nu x nv cells: `position(s, t)` and `uv(s, t)` for s, t in [0, 1]; the outside is
/// where d/ds x d/dt points.
void add_grid(Mesh& mesh, int nu, int nv,
              const std::function<Eigen::Vector3f(float, float)>& position,
              const std::function<Eigen::Vector2f(float, float)>& uv) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto stride = static_cast<std::uint32_t>(nu + 1);
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(nu);
      const float t = static_cast<float>(j) / static_cast<float>(nv);
      mesh.positions.push_back(position(s, t));
      mesh.uv.push_back(uv(s, t));
      mesh.normals.emplace_back(Eigen::Vector3f::UnitZ());
    }
  }
  const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Eigen::Vector3f& origin = mesh.positions[a];
    const Eigen::Vector3f e1 = mesh.positions[b] - origin;
    const Eigen::Vector3f e2 = mesh.positions[c] - origin;
    // At poles a cell has lost an edge; a sliver of rounding there has no usable normal.
    if (e1.cross(e2).squaredNorm() > 1e-20f) mesh.triangles.push_back({a, b, c});
  };
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(nv); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(nu); ++i) {
      const std::uint32_t a = first + j * stride + i;
      add_triangle(a, a + 1, a + stride + 1);
      add_triangle(a, a + stride + 1, a + stride);
    }
  }
}

/// Cells along an edge so that baked light has somewhere to live: about 48 along the longest.
int cells(double edge, double longest, int segments) {
  return std::max(1, static_cast<int>(std::lround(segments * edge / longest)));
}

void add_rectangle(Mesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& along_u,
                   const Eigen::Vector3f& along_v, int nu, int nv) {
  const std::size_t first = mesh.positions.size();
  const std::size_t first_triangle = mesh.triangles.size();
  const float width = along_u.norm();
  const float height = along_v.norm();
  add_grid(
      mesh, nu, nv,
      [&](float s, float t) { return Eigen::Vector3f(corner + s * along_u + t * along_v); },
      // Texture rows run downwards: v grows against along_v.
      [&](float s, float t) { return Eigen::Vector2f(s * width, (1.0f - t) * height); });
  const Eigen::Vector3f normal = along_u.cross(along_v).normalized();
  std::fill(mesh.normals.begin() + static_cast<std::ptrdiff_t>(first), mesh.normals.end(), normal);
  const auto columns = static_cast<std::uint32_t>(nu);
  const auto rows = static_cast<std::uint32_t>(nv);
  // A rectangle too small for its cells has lost some.
  if (mesh.triangles.size() - first_triangle != std::size_t{2} * columns * rows) return;
  mesh.rectangles.push_back({static_cast<std::uint32_t>(first),
                             static_cast<std::uint32_t>(first_triangle), columns, rows});
}

/// In the plane z = 0, facing +z, centred.
Mesh make_quad(const ObjectSpec& spec) {
  const Eigen::Vector3f size = spec.size.cast<float>();
  const double longest = std::max(spec.size.x(), spec.size.y());
  Mesh mesh;
  add_rectangle(mesh, {-0.5f * size.x(), -0.5f * size.y(), 0.0f}, {size.x(), 0.0f, 0.0f},
                {0.0f, size.y(), 0.0f}, cells(spec.size.x(), longest, spec.segments),
                cells(spec.size.y(), longest, spec.segments));
  return mesh;
}

Mesh make_box(const ObjectSpec& spec) {
  const Eigen::Vector3f s = spec.size.cast<float>();
  const Eigen::Vector3f h = 0.5f * s;
  const Eigen::Vector3f x(s.x(), 0, 0), y(0, s.y(), 0), z(0, 0, s.z());
  const double longest = spec.size.maxCoeff();
  // A box is mostly small: a quarter of a quad's cells per edge will do.
  const int segments = std::max(4, spec.segments / 4);
  const int nx = cells(spec.size.x(), longest, segments);
  const int ny = cells(spec.size.y(), longest, segments);
  const int nz = cells(spec.size.z(), longest, segments);
  Mesh mesh;
  add_rectangle(mesh, {-h.x(), -h.y(), -h.z()}, x, z, nx, nz);  // front, -y
  add_rectangle(mesh, {h.x(), h.y(), -h.z()}, -x, z, nx, nz);   // back, +y
  add_rectangle(mesh, {h.x(), -h.y(), -h.z()}, y, z, ny, nz);   // right, +x
  add_rectangle(mesh, {-h.x(), h.y(), -h.z()}, -y, z, ny, nz);  // left, -x
  add_rectangle(mesh, {-h.x(), -h.y(), h.z()}, x, y, nx, ny);   // top, +z
  add_rectangle(mesh, {-h.x(), h.y(), -h.z()}, x, -y, nx, ny);  // bottom, -z
  return mesh;
}

/// A curve (radius, height) turned about z. Heights rise; corners of the curve become smooth.
void add_revolution(Mesh& mesh, const std::vector<Eigen::Vector2f>& profile, int segments) {
  std::vector<float> arc{0.0f};
  float widest = 0.0f;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    widest = std::max(widest, profile[i].x());
    if (i > 0) arc.push_back(arc.back() + (profile[i] - profile[i - 1]).norm());
  }
  const int steps = static_cast<int>(profile.size()) - 1;
  const auto at = [&](float t) {
    return static_cast<std::size_t>(std::lround(t * static_cast<float>(steps)));
  };
  add_grid(
      mesh, segments, steps,
      [&](float s, float t) {
        const Eigen::Vector2f& p = profile[at(t)];
        const float angle = s < 1.0f ? kTwoPi * s : 0.0f;  // the seam closes exactly
        return Eigen::Vector3f(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
      },
      [&](float s, float t) {
        return Eigen::Vector2f(kTwoPi * widest * s, arc.back() - arc[at(t)]);
      });
}

/// An ellipsoid with the given extents.
Mesh make_sphere(const ObjectSpec& spec) {
  const int rings = std::max(4, spec.segments / 2);
  std::vector<Eigen::Vector2f> profile;
  for (int i = 0; i <= rings; ++i) {
    const double angle = std::numbers::pi * i / rings;
    const double radius = i == 0 || i == rings ? 0.0 : 0.5 * std::sin(angle);
    profile.emplace_back(radius, -0.5 * std::cos(angle));
  }
  Mesh mesh;
  add_revolution(mesh, profile, spec.segments);
  const Eigen::Vector3f size = spec.size.cast<float>();
  for (Eigen::Vector3f& p : mesh.positions) p = p.cwiseProduct(size);
  // Texture coordinates are those of the unit sphere: bring them to the mean size.
  for (Eigen::Vector2f& uv : mesh.uv) uv *= size.mean();
  smooth_normals(mesh);
  return mesh;
}

/// A disc facing up or down, for the ends of cylinders.
void add_disc(Mesh& mesh, float radius, float z, bool up, int segments) {
  const std::size_t first = mesh.positions.size();
  const float turn = up ? kTwoPi : -kTwoPi;
  const auto position = [=](float s, float t) {
    const float angle = s < 1.0f ? turn * s : 0.0f;
    const float r = radius * (1.0f - t);
    return Eigen::Vector3f(r * std::cos(angle), r * std::sin(angle), z);
  };
  add_grid(mesh, segments, 4, position, [&](float s, float t) {
    const Eigen::Vector3f p = position(s, t);
    return Eigen::Vector2f(p.x(), -p.y());
  });
  std::fill(mesh.normals.begin() + static_cast<std::ptrdiff_t>(first), mesh.normals.end(),
            Eigen::Vector3f(0.0f, 0.0f, up ? 1.0f : -1.0f));
}

/// Diameter size.x, height size.z, centred, axis z.
Mesh make_cylinder(const ObjectSpec& spec) {
  const float radius = 0.5f * static_cast<float>(spec.size.x());
  const float half = 0.5f * static_cast<float>(spec.size.z());
  constexpr int kRings = 12;
  std::vector<Eigen::Vector2f> side;
  for (int i = 0; i <= kRings; ++i) {
    side.emplace_back(radius, -half + 2.0f * half * static_cast<float>(i) / kRings);
  }
  Mesh mesh;
  add_revolution(mesh, side, spec.segments);
  smooth_normals(mesh);
  add_disc(mesh, radius, half, true, spec.segments);
  add_disc(mesh, radius, -half, false, spec.segments);
  return mesh;
}

/// Ring of outer diameter size.x about z with a tube of radius tube_m.
Mesh make_torus(const ObjectSpec& spec) {
  const float tube = static_cast<float>(spec.tube_m);
  const float ring = 0.5f * static_cast<float>(spec.size.x()) - tube;
  Mesh mesh;
  add_grid(
      mesh, spec.segments, std::max(8, spec.segments / 2),
      [&](float s, float t) {
        const float around = s < 1.0f ? kTwoPi * s : 0.0f;
        const float along = t < 1.0f ? kTwoPi * t : 0.0f;
        const float r = ring + tube * std::cos(along);
        return Eigen::Vector3f(r * std::cos(around), r * std::sin(around), tube * std::sin(along));
      },
      [&](float s, float t) {
        return Eigen::Vector2f(kTwoPi * ring * s, kTwoPi * tube * (1.0f - t));
      });
  smooth_normals(mesh);
  return mesh;
}

/// The profile refined so that displacement and baked light have vertices to act on.
Mesh make_lathe(const ObjectSpec& spec) {
  double length = 0.0;
  for (std::size_t i = 1; i < spec.profile.size(); ++i) {
    length += (spec.profile[i] - spec.profile[i - 1]).norm();
  }
  std::vector<Eigen::Vector2f> fine{spec.profile.front().cast<float>()};
  for (std::size_t i = 1; i < spec.profile.size(); ++i) {
    const Eigen::Vector2d from = spec.profile[i - 1];
    const Eigen::Vector2d step = spec.profile[i] - from;
    const int pieces = cells(step.norm(), length, spec.segments);
    for (int k = 1; k <= pieces; ++k) fine.push_back((from + step * k / pieces).cast<float>());
  }
  Mesh mesh;
  add_revolution(mesh, fine, spec.segments);
  smooth_normals(mesh);
  return mesh;
}

/// A convex outline, counter-clockwise, raised from z = 0 to size.z.
Mesh make_extrusion(const ObjectSpec& spec) {
  const float height = static_cast<float>(spec.size.z());
  const std::size_t n = spec.profile.size();
  Mesh mesh;
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  for (const Eigen::Vector2d& p : spec.profile) middle += p.cast<float>() / static_cast<float>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2f a = spec.profile[i].cast<float>();
    const Eigen::Vector2f b = spec.profile[(i + 1) % n].cast<float>();
    add_rectangle(mesh, {a.x(), a.y(), 0.0f}, {b.x() - a.x(), b.y() - a.y(), 0.0f},
                  {0.0f, 0.0f, height}, 8, 8);
    for (const bool top : {true, false}) {
      const float z = top ? height : 0.0f;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Eigen::Vector2f& p : {middle, top ? a : b, top ? b : a}) {
        mesh.positions.emplace_back(p.x(), p.y(), z);
        mesh.normals.emplace_back(0.0f, 0.0f, top ? 1.0f : -1.0f);
        mesh.uv.emplace_back(p.x(), -p.y());
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return mesh;
}

Mesh make_undisplaced(const ObjectSpec& spec) {
  switch (spec.shape) {
    case Shape::Quad:
      return make_quad(spec);
    case Shape::Box:
      return make_box(spec);
    case Shape::Sphere:
      return make_sphere(spec);
    case Shape::Cylinder:
      return make_cylinder(spec);
    case Shape::Torus:
      return make_torus(spec);
    case Shape::Lathe:
      return make_lathe(spec);
    case Shape::Extrusion:
      return make_extrusion(spec);
    case Shape::Mesh:
      return read_obj(spec.file);
  }
  return {};
}

}  // namespace

Mesh make_shape(const ObjectSpec& spec) {
  Mesh mesh = make_undisplaced(spec);
  displace(mesh, spec.displacement);
  return mesh;
}

}  // namespace lumibox::hal::sim
