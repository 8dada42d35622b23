#include "render/strokes.h"

#include <algorithm>

namespace lumibox::render {
namespace {

/// Room around a shape for its antialiased edge, pixels.
constexpr float kEdge = 1.0F;

/// Sideways direction of the line at point i, as long as a mitre joint needs it to be.
Eigen::Vector2f sideways(std::span<const StrokePoint> points, std::size_t i) {
  const auto side_of = [](const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
    const Eigen::Vector2f along = to - from;
    const float length = along.norm();
    return length > 0.0F ? Eigen::Vector2f(Eigen::Vector2f(-along.y(), along.x()) / length)
                         : Eigen::Vector2f::Zero();
  };
  const std::size_t last = points.size() - 1;
  const Eigen::Vector2f before =
      side_of(points[i > 0 ? i - 1 : 0].position, points[i > 0 ? i : 1].position);
  const Eigen::Vector2f after =
      side_of(points[i < last ? i : last - 1].position, points[i < last ? i + 1 : last].position);
  const Eigen::Vector2f sum = before + after;
  // |sum|^2 / 2 = 1 + cos of the turn; sharp turns are cut off rather than drawn out to a spike.
  return 2.0F * sum / std::max(1.0F, sum.squaredNorm());
}

}  // namespace

float stroke_scale(int height) {
  return std::max(0.6F, static_cast<float>(height) / 480.0F);
}

void Strokes::line(std::span<const StrokePoint> points, float half_width, const Color& color) {
  if (points.size() < 2) return;
  const float reach = half_width + kEdge;
  StrokeVertex left_before;
  StrokeVertex right_before;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2f side = sideways(points, i) * reach;
    Color faded = color;
    faded.a *= points[i].opacity;
    const StrokeVertex left{points[i].position + side, {0.0F, reach}, half_width, faded};
    const StrokeVertex right{points[i].position - side, {0.0F, -reach}, half_width, faded};
    if (i > 0) quad(left_before, right_before, left, right);
    left_before = left;
    right_before = right;
  }
}

void Strokes::disc(const Eigen::Vector2f& center, float radius, const Color& color) {
  const float reach = radius + kEdge;
  const auto corner = [&](float x, float y) {
    const Eigen::Vector2f offset(x * reach, y * reach);
    return StrokeVertex{center + offset, offset, radius, color};
  };
  quad(corner(-1.0F, -1.0F), corner(1.0F, -1.0F), corner(-1.0F, 1.0F), corner(1.0F, 1.0F));
}

void Strokes::quad(const StrokeVertex& a, const StrokeVertex& b, const StrokeVertex& c,
                   const StrokeVertex& d) {
  vertices_.insert(vertices_.end(), {a, b, c, c, b, d});
}

}  // namespace lumibox::render
