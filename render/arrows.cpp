#include "render/arrows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumibox::render {
namespace {

constexpr Color kYellow{1.0F, 0.85F, 0.2F, 1.0F};  // as what to do is written
constexpr float kHalfWidth = 1.6F;
constexpr float kMarginAside = 0.05F;   // of the width
constexpr float kMarginOfText = 0.19F;  // of the height: two lines at the top or at the bottom
constexpr float kLength = 26.0F;        // of the arrow at the edge, pixels of a picture of 480 rows
constexpr float kHead = 14.0F;

}  // namespace

void draw_arrow(Strokes& strokes, std::span<const StrokePoint> points, float head, float scale) {
  if (points.size() < 2) return;
  const StrokePoint& tip = points.back();
  const Eigen::Vector2f along = (tip.position - points[points.size() - 2].position).normalized();
  if (!along.allFinite()) return;
  const Eigen::Vector2f across(-along.y(), along.x());
  const auto draw = [&](float half_width, Color color) {
    strokes.line(points, half_width, color);
    for (const float side : {-1.0F, 1.0F}) {
      const std::array<StrokePoint, 2> barb = {
          StrokePoint{tip.position - head * (along + 0.7F * side * across), tip.opacity}, tip};
      strokes.line(barb, half_width, color);
    }
  };
  draw((kHalfWidth + 1.1F) * scale, {0.0F, 0.0F, 0.0F, 0.6F});
  draw(kHalfWidth * scale, kYellow);
}

Strokes edge_arrow(const Eigen::Vector2d& way, int width, int height) {
  Strokes strokes;
  const Eigen::Vector2f along = way.normalized().cast<float>();
  if (!along.allFinite() || along.isZero()) return strokes;
  const Eigen::Vector2f size(static_cast<float>(width), static_cast<float>(height));
  const Eigen::Vector2f middle = 0.5F * (size - Eigen::Vector2f::Ones());
  // How far from the middle the arrow's tip may be before it leaves the room for it.
  const Eigen::Vector2f room(middle.x() - kMarginAside * size.x(),
                             middle.y() - kMarginOfText * size.y());
  const float reach = std::min(room.x() / std::max(std::abs(along.x()), 1e-6F),
                               room.y() / std::max(std::abs(along.y()), 1e-6F));
  const float scale = stroke_scale(height);
  const std::array<StrokePoint, 2> line = {
      StrokePoint{middle + (reach - kLength * scale) * along, 1.0F},
      StrokePoint{middle + reach * along, 1.0F}};
  draw_arrow(strokes, line, kHead * scale, 1.5F * scale);
  return strokes;
}

}  // namespace lumibox::render
