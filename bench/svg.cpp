#include "bench/svg.h"

#include <fmt/core.h>

#include <iterator>

#include "config/output_file.h"

namespace lumibox::bench {
namespace {

/// Of text between tags. XML allows no control characters at all.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' ? '?' : c;
    }
  }
  return result;
}

std::string attributes(const Style& style) {
  std::string text = fmt::format("fill=\"{}\" stroke=\"{}\"", style.fill, style.stroke);
  if (style.stroke != "none") text += fmt::format(" stroke-width=\"{}\"", style.width);
  if (style.opacity != 1.0) text += fmt::format(" opacity=\"{}\"", style.opacity);
  if (!style.dashes.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", style.dashes);
  return text;
}

std::string place(const Vector2d& point) {
  return fmt::format("{:.2f} {:.2f}", point.x(), point.y());
}

}  // namespace

Svg::Svg(double width, double height)
    : head_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                        "viewBox=\"0 0 {0} {1}\" font-family=\"DejaVu Sans, Verdana, sans-serif\">"
                        "\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
                        width, height)) {}

void Svg::line(const Vector2d& a, const Vector2d& b, const Style& style) {
  const Vector2d ends[] = {a, b};
  if (a.allFinite() && b.allFinite()) polyline(ends, style);
}

void Svg::polyline(std::span<const Vector2d> points, const Style& style) {
  std::string path;
  char command = 'M';
  for (const Vector2d& point : points) {
    if (point.allFinite()) path += command + place(point);
    command = point.allFinite() ? 'L' : 'M';
  }
  if (path.empty()) return;
  body_ += fmt::format("<path d=\"{}\" stroke-linejoin=\"round\" {}/>\n", path, attributes(style));
}

void Svg::dots(std::span<const Vector2d> points, double radius, const Style& style) {
  // Lines of no length with round ends: a fifth of the text that circles take.
  std::string path;
  for (const Vector2d& point : points) {
    if (point.allFinite()) path += 'M' + place(point) + "h0";
  }
  if (path.empty()) return;
  body_ += fmt::format(
      "<path d=\"{}\" stroke-linecap=\"round\" {}/>\n", path,
      attributes({.stroke = style.fill, .width = 2 * radius, .opacity = style.opacity}));
}

void Svg::circle(const Vector2d& center, double radius, const Style& style) {
  if (!center.allFinite() || !std::isfinite(radius)) return;
  body_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", center.x(),
                       center.y(), radius, attributes(style));
}

void Svg::rect(const Vector2d& corner, const Vector2d& size, const Style& style) {
  if (!corner.allFinite() || !size.allFinite()) return;
  body_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n",
                       corner.x(), corner.y(), size.x(), size.y(), attributes(style));
}

void Svg::text(const Vector2d& at, std::string_view text, const TextStyle& style) {
  if (!at.allFinite()) return;
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  body_ += fmt::format(
      "<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2}\" text-anchor=\"{3}\" fill=\"{4}\"{5}{6}>",
      at.x(), at.y(), style.size, kAnchors[static_cast<int>(style.anchor)], style.color,
      style.bold ? " font-weight=\"bold\"" : "",
      style.upwards ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", at.x(), at.y()) : "");
  body_ += escaped(text) + "</text>\n";
}

void Svg::clip(const Vector2d& corner, const Vector2d& size) {
  const int id = clips_++;
  body_ += fmt::format("<clipPath id=\"clip{}\">", id);
  rect(corner, size, {});
  body_ += fmt::format("</clipPath>\n<g clip-path=\"url(#clip{})\">\n", id);
}

void Svg::unclip() {
  body_ += "</g>\n";
}

std::string Svg::str() const {
  return head_ + body_ + "</svg>\n";
}

void write_svg(const std::filesystem::path& file, const Svg& svg) {
  config::write_text(file, svg.str());
}

}  // namespace lumibox::bench
