#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace lumibox::bench {

using Vector2d = Eigen::Vector2d;

/// How a shape is drawn; colours as CSS has them.
struct Style {
  std::string_view stroke = "none";
  double width = 1.0;  ///< of the stroke
  std::string_view fill = "none";
  double opacity = 1.0;
  std::string_view dashes = "";  ///< e.g. "4 3"; empty: none
};

enum class Anchor { Start, Middle, End };

struct TextStyle {
  double size = 12.0;
  Anchor anchor = Anchor::Start;
  std::string_view color = "#222";
  bool bold = false;
  bool upwards = false;  ///< turned by 90 degrees, to be read from the right
};

/// A drawing as SVG 1.1: x to the right, y down, in pixels, on white. What is drawn later lies
/// above. A shape with a coordinate that is not finite is left out: one such number would make the
/// whole file unreadable.
class Svg {
 public:
  Svg(double width, double height);

  void line(const Vector2d& a, const Vector2d& b, const Style& style);

  /// Broken where a point is not finite.
  void polyline(std::span<const Vector2d> points, const Style& style);

  /// Small discs of one colour.
  void dots(std::span<const Vector2d> points, double radius, const Style& style);
  void circle(const Vector2d& center, double radius, const Style& style);
  void rect(const Vector2d& corner, const Vector2d& size, const Style& style);

  /// `at` is on the base line.
  void text(const Vector2d& at, std::string_view text, const TextStyle& style = {});

  /// What follows is cut off at a rectangle's border, until unclip().
  void clip(const Vector2d& corner, const Vector2d& size);
  void unclip();

  std::string str() const;

 private:
  std::string head_;
  std::string body_;
  int clips_ = 0;
};

/// Throws config::InputError if the file cannot be written.
void write_svg(const std::filesystem::path& file, const Svg& svg);

}  // namespace lumibox::bench
