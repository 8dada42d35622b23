#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace lumibox::render {

/// Where a glyph's picture lies in the atlas and where it goes on the line.
struct GlyphPicture {
  int x = 0, y = 0;           ///< top left corner in the atlas, pixels
  int width = 0, height = 0;  ///< pixels; 0 for a blank
  int left = 0;               ///< from the pen to the left edge, pixels
  int top = 0;                ///< from the baseline up to the top edge, pixels
};

/// A character at one size: its face, and the wider shape that is drawn dark behind it.
struct Glyph {
  GlyphPicture face;
  GlyphPicture outline;
  float advance = 0.0F;  ///< pixels to the next pen position
};

/// Glyphs of DejaVu Sans, drawn by FreeType into one picture as they are first needed.
class Font {
 public:
  static constexpr int kAtlasSize = 1024;

  /// Throws config::InputError naming the places searched if the font is not installed.
  Font();
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Glyph of a Unicode code point; one that the font lacks shows as its box. Valid until the next
  /// call: a full atlas is emptied and started again.
  const Glyph& glyph(char32_t code_point, int size_px);

  /// kAtlasSize squared bytes, 255 where covered; changes when revision() does.
  const std::vector<std::uint8_t>& atlas() const;
  std::uint64_t revision() const;

  /// Counts how often the atlas was emptied: glyphs from before are gone.
  std::uint64_t generation() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Code points of UTF-8; U+FFFD stands for each byte that is not.
std::vector<char32_t> decode_utf8(std::string_view text);

}  // namespace lumibox::render
