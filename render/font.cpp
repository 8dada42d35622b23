#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_STROKER_H

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "config/error.h"

namespace lumibox::render {
namespace {

constexpr std::array kCandidates = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
};

/// Width of the dark outline as a share of the size.
constexpr double kOutline = 0.09;
constexpr int kGap = 1;  ///< empty texels between glyphs, so that none bleeds into the next

}  // namespace

class Font::Impl {
 public:
  Impl() : atlas_(static_cast<std::size_t>(kAtlasSize) * kAtlasSize) {
    if (FT_Init_FreeType(&library_) != 0) throw config::InputError("FreeType does not start");
    std::string searched;
    for (const char* path : kCandidates) {
      if (FT_New_Face(library_, path, 0, &face_) == 0) break;
      searched += std::string(searched.empty() ? "" : ", ") + path;
    }
    if (face_ == nullptr) {
      FT_Done_FreeType(library_);
      throw config::InputError("no font for the screen: expected DejaVu Sans at one of " +
                               searched + " (Debian package fonts-dejavu-core)");
    }
    FT_Stroker_New(library_, &stroker_);
  }

  ~Impl() {
    FT_Stroker_Done(stroker_);
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }

  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  const Glyph& glyph(char32_t code_point, int size_px) {
    const auto found = glyphs_.find({code_point, size_px});
    if (found != glyphs_.end()) return found->second;
    Glyph glyph;
    if (!draw(code_point, size_px, glyph)) {
      empty();
      // In an empty atlas only a glyph larger than all of it fails, which then stays blank.
      draw(code_point, size_px, glyph);
    }
    return glyphs_.emplace(std::pair(code_point, size_px), glyph).first->second;
  }

  const std::vector<std::uint8_t>& atlas() const { return atlas_; }
  std::uint64_t revision() const { return revision_; }
  std::uint64_t generation() const { return generation_; }

 private:
  void empty() {
    std::fill(atlas_.begin(), atlas_.end(), std::uint8_t{0});
    glyphs_.clear();
    pen_x_ = pen_y_ = row_height_ = 0;
    ++revision_;
    ++generation_;
  }

  /// False if the atlas has no room.
  bool draw(char32_t code_point, int size_px, Glyph& glyph) {
    if (FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(size_px)) != 0) return true;
    if (FT_Load_Char(face_, code_point, FT_LOAD_NO_BITMAP | FT_LOAD_TARGET_LIGHT) != 0) return true;
    glyph.advance = static_cast<float>(face_->glyph->advance.x) / 64.0F;
    FT_Stroker_Set(stroker_, static_cast<FT_Fixed>(64.0 * std::max(1.0, kOutline * size_px)),
                   FT_STROKER_LINECAP_ROUND, FT_STROKER_LINEJOIN_ROUND, 0);
    return draw_picture(false, glyph.face) && draw_picture(true, glyph.outline);
  }

  /// Renders the loaded glyph, or its outline, into the atlas.
  bool draw_picture(bool outline, GlyphPicture& picture) {
    FT_Glyph shape = nullptr;
    if (FT_Get_Glyph(face_->glyph, &shape) != 0) return true;
    if (outline) FT_Glyph_StrokeBorder(&shape, stroker_, 0, 1);
    bool fits = true;
    if (FT_Glyph_To_Bitmap(&shape, FT_RENDER_MODE_NORMAL, nullptr, 1) == 0) {
      const auto* bitmap = reinterpret_cast<FT_BitmapGlyph>(shape);
      fits = place(bitmap->bitmap, picture);
      picture.left = bitmap->left;
      picture.top = bitmap->top;
    }
    FT_Done_Glyph(shape);
    return fits;
  }

  /// Copies a bitmap to the next free place: rows from left to right, as high as their highest.
  bool place(const FT_Bitmap& bitmap, GlyphPicture& picture) {
    const int width = static_cast<int>(bitmap.width);
    const int height = static_cast<int>(bitmap.rows);
    if (pen_x_ + width > kAtlasSize) {
      pen_x_ = 0;
      pen_y_ += row_height_ + kGap;
      row_height_ = 0;
    }
    if (width > kAtlasSize || pen_y_ + height > kAtlasSize) return false;
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* from = bitmap.buffer + static_cast<std::ptrdiff_t>(y) * bitmap.pitch;
      std::copy_n(from, width,
                  atlas_.begin() + static_cast<std::ptrdiff_t>(pen_y_ + y) * kAtlasSize + pen_x_);
    }
    picture.x = pen_x_;
    picture.y = pen_y_;
    picture.width = width;
    picture.height = height;
    pen_x_ += width + kGap;
    row_height_ = std::max(row_height_, height);
    ++revision_;
    return true;
  }

  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
  FT_Stroker stroker_ = nullptr;
  std::vector<std::uint8_t> atlas_;
  std::map<std::pair<char32_t, int>, Glyph> glyphs_;
  int pen_x_ = 0;
  int pen_y_ = 0;
  int row_height_ = 0;
  std::uint64_t revision_ = 1;
  std::uint64_t generation_ = 1;
};

Font::Font() : impl_(std::make_unique<Impl>()) {}
Font::~Font() = default;

const Glyph& Font::glyph(char32_t code_point, int size_px) {
  return impl_->glyph(code_point, size_px);
}
const std::vector<std::uint8_t>& Font::atlas() const {
  return impl_->atlas();
}
std::uint64_t Font::revision() const {
  return impl_->revision();
}
std::uint64_t Font::generation() const {
  return impl_->generation();
}

std::vector<char32_t> decode_utf8(std::string_view text) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::vector<char32_t> result;
  std::size_t i = 0;
  while (i < text.size()) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int following = lead < 0x80                   ? 0
                          : lead >= 0xC2 && lead < 0xE0 ? 1
                          : lead >= 0xE0 && lead < 0xF0 ? 2
                          : lead >= 0xF0 && lead < 0xF5 ? 3
                                                        : -1;
    if (following < 0 || i + static_cast<std::size_t>(following) > text.size()) {
      result.push_back(kReplacement);
      continue;
    }
    char32_t value = following == 0 ? lead : lead & (0x3FU >> following);
    bool valid = true;
    for (int j = 0; j < following; ++j) {
      const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(j)]);
      valid = valid && (next & 0xC0U) == 0x80U;
      value = (value << 6U) | (next & 0x3FU);
    }
    result.push_back(valid ? value : kReplacement);
    if (valid) i += static_cast<std::size_t>(following);
  }
  return result;
}

}  // namespace lumibox::render
