#include "render/picture_cache.h"

#include <algorithm>
#include <bit>
#include <string>

#include "config/error.h"

namespace lumibox::render {
namespace {

/// Slots beyond those of one view, so that a moving view finds most of its pictures. 64 pictures of
/// 640x480, enough for k = 40 and those around it, take 79 MB.
constexpr std::size_t kLeastSlots = 64;
/// Spare slots are given up where all of them would take more than this.
constexpr std::size_t kMostSpareBytes = 512U << 20U;

/// Four bytes a pixel, which every GPU samples directly; the alpha is not used.
void add_alpha(const hal::Image& rgb, std::vector<std::uint8_t>& rgba) {
  const std::size_t pixels = rgb.size_bytes() / 3;
  rgba.resize(pixels * 4);
  const std::uint8_t* from = rgb.data();
  std::uint8_t* to = rgba.data();
  for (std::size_t i = 0; i < pixels; ++i, from += 3, to += 4) {
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
    to[3] = 255;
  }
}

}  // namespace

void PictureCache::begin_view(std::size_t pictures, int width, int height) {
  slots_.begin_view();
  if (pictures <= slots_.size() && width <= width_ && height <= height_) return;
  width = std::max(width, width_);
  height = std::max(height, height_);
  const std::size_t slot_bytes =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
  const std::size_t wanted = std::max({kLeastSlots, std::bit_ceil(pictures), slots_.size()});
  allocate(wanted * slot_bytes <= kMostSpareBytes ? wanted : pictures, width, height);
}

void PictureCache::allocate(std::size_t slots, int width, int height) {
  texture_ = gl::Texture();  // frees the old one before the new one is needed
  texture_ = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  while (glGetError() != GL_NO_ERROR) {
  }
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, width, height, static_cast<GLsizei>(slots));
  const bool failed = glGetError() != GL_NO_ERROR;
  slots_.reset(failed ? 0 : slots);
  width_ = failed ? 0 : width;
  height_ = failed ? 0 : height;
  if (failed) {
    throw config::InputError("the GPU has no room for " + std::to_string(slots) + " pictures of " +
                             std::to_string(width) + "x" + std::to_string(height) +
                             " pixels; a smaller render.k needs less");
  }
}

std::optional<int> PictureCache::slot_of(const std::shared_ptr<const lightfield::Photo>& picture) {
  const auto [slot, is_new] = slots_.place_of(picture);
  if (is_new) {
    const auto pixels = picture->rgb();
    if (!pixels) {
      slots_.forget(slot);
      return std::nullopt;
    }
    upload(*pixels, slot);
  }
  return static_cast<int>(slot);
}

void PictureCache::upload(const hal::Image& picture, std::size_t slot) {
  add_alpha(picture, rgba_);
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(slot), picture.width(),
                  picture.height(), 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
}

}  // namespace lumibox::render
