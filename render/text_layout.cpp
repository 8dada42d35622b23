#include "render/text_layout.h"

#include <algorithm>
#include <cmath>

namespace lumibox::render {
namespace {

constexpr float kSmallest = 4.0F;   ///< pixels
constexpr float kLargest = 200.0F;  ///< pixels

void add_quad(std::vector<TextVertex>& vertices, const GlyphPicture& picture,
              const Eigen::Vector2f& pen, const Color& color) {
  const Eigen::Vector2f corner =
      pen + Eigen::Vector2f(static_cast<float>(picture.left), static_cast<float>(-picture.top));
  const auto vertex = [&](int x, int y) {
    const Eigen::Vector2f offset(static_cast<float>(x * picture.width),
                                 static_cast<float>(y * picture.height));
    const Eigen::Vector2f origin(static_cast<float>(picture.x), static_cast<float>(picture.y));
    return TextVertex{corner + offset, origin + offset, color};
  };
  vertices.insert(vertices.end(), {vertex(0, 0), vertex(1, 0), vertex(0, 1), vertex(0, 1),
                                   vertex(1, 0), vertex(1, 1)});
}

void add_line(std::vector<TextVertex>& vertices, const Text& line, Font& font, bool outline) {
  const int size =
      static_cast<int>(std::lround(std::min(std::max(kSmallest, line.size), kLargest)));
  const Color dark{0.0F, 0.0F, 0.0F, 0.75F * line.color.a};
  Eigen::Vector2f pen(line.x, std::round(line.y));
  for (const char32_t code_point : decode_utf8(line.utf8)) {
    const Glyph& glyph = font.glyph(code_point, size);
    // Whole pixels, or the texels would be smeared over two.
    const Eigen::Vector2f at(std::round(pen.x()), pen.y());
    add_quad(vertices, outline ? glyph.outline : glyph.face, at, outline ? dark : line.color);
    pen.x() += glyph.advance;
  }
}

std::vector<TextVertex> attempt(const std::vector<Text>& lines, Font& font) {
  std::vector<TextVertex> vertices;
  for (const bool outline : {true, false}) {
    for (const Text& line : lines) add_line(vertices, line, font, outline);
  }
  return vertices;
}

}  // namespace

std::vector<TextVertex> lay_out(const std::vector<Text>& lines, Font& font) {
  const std::uint64_t generation = font.generation();
  std::vector<TextVertex> vertices = attempt(lines, font);
  // The atlas ran full on the way: what was laid out before refers to glyphs that are gone.
  if (font.generation() != generation) vertices = attempt(lines, font);
  return vertices;
}

}  // namespace lumibox::render
