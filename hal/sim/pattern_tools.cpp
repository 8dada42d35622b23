#include "hal/sim/pattern_tools.h"

namespace lumibox::hal::sim {

const Color& pick(const std::vector<Color>& palette, Random& random) {
  return palette[static_cast<std::size_t>(random.below(static_cast<int>(palette.size())))];
}

Color shade(const Color& color, double factor) {
  return (color * static_cast<float>(factor)).max(0.0f).min(1.0f);
}

int count(double extent, double cell) {
  return std::max(1, static_cast<int>(std::lround(extent / cell)));
}

void glyph(Canvas& canvas, const Eigen::Vector2d& corner, double height, const Color& ink,
           Random& random) {
  const double step = height / 3.0;
  const int strokes = 3 + random.below(3);
  int x = random.below(3);
  int y = random.below(4);
  for (int i = 0; i < strokes; ++i) {
    const int nx = random.below(3);
    const int ny = random.below(4);
    canvas.stroke(corner + step * Eigen::Vector2d(0.8 * x, y),
                  corner + step * Eigen::Vector2d(0.8 * nx, ny), 0.16 * height, ink);
    x = nx;
    y = ny;
  }
}

}  // namespace lumibox::hal::sim
