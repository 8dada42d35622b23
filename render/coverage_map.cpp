#include "render/coverage_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/rotation.h"
#include "lightfield/coverage.h"
#include "render/arrows.h"
#include "render/quality_color.h"

namespace lumibox::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMeridians = 12;
constexpr int kParallels = 7;
constexpr int kPieces = 96;  ///< straight pieces of a circle
constexpr float kFarOpacity = 0.22F;

constexpr int kArrowPieces = 24;

const Color kWhite{1.0F, 1.0F, 1.0F, 1.0F};
const Color kRed{1.0F, 0.16F, 0.12F, 1.0F};
const Color kShadow{0.0F, 0.0F, 0.0F, 1.0F};

/// Where the sphere's points are on the screen.
class Projection {
 public:
  Projection(const lightfield::Sphere& sphere, const View& view)
      : sphere_(sphere), profile_(view.camera.profile()), camera_(view.world_from_camera) {}

  /// The point of the sphere in this direction (unit, in world); none if it is not before the view.
  std::optional<StrokePoint> project(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d point = sphere_.center + sphere_.radius * direction;
    const std::optional<Eigen::Vector2f> pixel = pixel_of(point);
    if (!pixel) return std::nullopt;
    // Cosine between the surface's normal and the way to the eye: positive on the near side.
    const double facing = direction.dot((eye() - point).normalized());
    const auto nearness = static_cast<float>(std::clamp(0.5 + facing / 0.2, 0.0, 1.0));
    return StrokePoint{*pixel, kFarOpacity + (1.0F - kFarOpacity) * nearness};
  }

  std::optional<Eigen::Vector2f> pixel_of(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = camera_.inverse() * point;
    if (!(p.z() > 0.02 * sphere_.radius)) return std::nullopt;
    return Eigen::Vector2f(static_cast<float>(profile_.fx * p.x() / p.z() + profile_.cx),
                           static_cast<float>(profile_.fy * p.y() / p.z() + profile_.cy));
  }

  const Eigen::Vector3d& eye() const { return camera_.translation; }

  float scale() const { return stroke_scale(profile_.height); }

 private:
  lightfield::Sphere sphere_;
  config::CameraProfile profile_;
  geometry::Pose camera_;
};

/// A line with a dark seam, so that it is seen on a white wall too.
void draw_line(Strokes& strokes, const std::vector<StrokePoint>& points, float half_width,
               float opacity, float scale) {
  Color seam = kShadow;
  seam.a = 0.35F * opacity;
  strokes.line(points, (half_width + 0.9F) * scale, seam);
  Color core = kWhite;
  core.a = opacity;
  strokes.line(points, half_width * scale, core);
}

/// The closed curve of unit directions at(angle), angle from 0 to 2 pi, broken where it passes
/// behind the view.
template <typename Curve>
void draw_circle(Strokes& strokes, const Projection& projection, float opacity, const Curve& at) {
  std::vector<StrokePoint> points;
  for (int i = 0; i <= kPieces; ++i) {
    const auto point = projection.project(at(2.0 * kPi * i / kPieces));
    if (point) points.push_back(*point);
    if (!point || i == kPieces) {
      draw_line(strokes, points, 0.55F, opacity, projection.scale());
      points.clear();
    }
  }
}

void draw_grid(Strokes& strokes, const Projection& projection) {
  for (int i = 0; i < kMeridians / 2; ++i) {
    const double longitude = kPi * i / (kMeridians / 2);
    draw_circle(strokes, projection, 0.6F, [longitude](double angle) {
      return Eigen::Vector3d(std::sin(angle) * std::cos(longitude), std::cos(angle),
                             std::sin(angle) * std::sin(longitude));
    });
  }
  for (int i = 1; i <= kParallels; ++i) {
    const double polar = kPi * i / (kParallels + 1);
    draw_circle(strokes, projection, 0.6F, [polar](double angle) {
      return Eigen::Vector3d(std::sin(polar) * std::cos(angle), std::cos(polar),
                             std::sin(polar) * std::sin(angle));
    });
  }
}

/// The outline: where lines of sight touch the sphere, a circle around the way to the eye.
void draw_outline(Strokes& strokes, const Projection& projection,
                  const lightfield::Sphere& sphere) {
  const Eigen::Vector3d towards_eye = projection.eye() - sphere.center;
  const double distance = towards_eye.norm();
  if (distance <= sphere.radius) return;
  const Eigen::Vector3d axis = towards_eye / distance;
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const double cosine = sphere.radius / distance;
  const double sine = std::sqrt(1.0 - cosine * cosine);
  std::vector<StrokePoint> points;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = 2.0 * kPi * i / kPieces;
    const Eigen::Vector3d direction =
        cosine * axis + sine * (std::cos(angle) * u + std::sin(angle) * v);
    const auto pixel = projection.pixel_of(sphere.center + sphere.radius * direction);
    if (pixel) points.push_back({*pixel, 1.0F});
    if (!pixel || i == kPieces) {
      draw_line(strokes, points, 0.9F, 0.9F, projection.scale());
      points.clear();
    }
  }
}

/// Thesis 2.3: the centre projected onto the sphere along the line to S.
void draw_dot(Strokes& strokes, const Projection& projection, const lightfield::Sphere& sphere,
              const Eigen::Vector3d& center, float radius, const Color& color) {
  const auto dot = lightfield::dot_on_sphere(sphere, center);
  if (!dot) return;
  const auto point = projection.project((*dot - sphere.center) / sphere.radius);
  if (!point) return;
  const float scale = projection.scale();
  const float opacity = std::max(point->opacity, 0.4F);
  Color seam = kShadow;
  seam.a = 0.7F * opacity;
  strokes.disc(point->position, (radius + 1.2F) * scale, seam);
  Color core = color;
  core.a = opacity;
  strokes.disc(point->position, radius * scale, core);
}

/// A ring around the dot: a difference in shape, where colours alone might not be told apart.
void draw_ring(Strokes& strokes, const Projection& projection, const Coverage::Dot& dot,
               const lightfield::Sphere& sphere) {
  draw_dot(strokes, projection, sphere, dot.center, 7.2F, kShadow);
  draw_dot(strokes, projection, sphere, dot.center, 6.6F, color_of_quality(0.0));
}

/// Along the great circle from the dot of the current centre to the hole.
void draw_way(Strokes& strokes, const Projection& projection, const Coverage& coverage) {
  const Eigen::Vector3d from = (*coverage.current - coverage.sphere.center).normalized();
  if (!from.allFinite() || !coverage.hole->allFinite()) return;
  std::vector<StrokePoint> points;
  for (int i = 0; i <= kArrowPieces; ++i) {
    const auto point =
        projection.project(geometry::slerp(from, *coverage.hole, i / double{kArrowPieces}));
    if (!point) return;
    points.push_back({point->position, std::max(point->opacity, 0.4F)});
  }
  draw_arrow(strokes, points, 9.0F * projection.scale(), projection.scale());
}

}  // namespace

Strokes coverage_map(const Coverage& coverage, const View& view) {
  const lightfield::Sphere& sphere = coverage.sphere;
  Strokes strokes;
  if (!(sphere.radius > 0.0) || !sphere.center.allFinite()) return strokes;
  const Projection projection(sphere, view);
  draw_grid(strokes, projection);
  draw_outline(strokes, projection, sphere);
  if (coverage.current && coverage.hole) draw_way(strokes, projection, coverage);
  for (const Coverage::Dot& dot : coverage.recorded) {
    if (dot.disagrees) draw_ring(strokes, projection, dot, sphere);
    draw_dot(strokes, projection, sphere, dot.center, 3.2F, color_of_quality(dot.psnr));
  }
  if (coverage.current) draw_dot(strokes, projection, sphere, *coverage.current, 5.5F, kRed);
  return strokes;
}

}  // namespace lumibox::render
