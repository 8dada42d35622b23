#include "render/picture_cache.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "config/error.h"

namespace lumibox::render {
namespace {

/// Four bytes a pixel, which every GPU samples directly: three would be turned into four by the
/// driver, in three times as long. The fourth is not looked at, so a pixel is moved with whatever
/// byte comes after it.
void spread(const hal::Image& rgb, std::vector<std::uint8_t>& rgba) {
  const std::size_t pixels = rgb.size_bytes() / 3;
  rgba.resize(pixels * 4);
  const std::uint8_t* from = rgb.data();
  std::uint8_t* to = rgba.data();
  for (std::size_t i = 1; i < pixels; ++i, from += 3, to += 4) std::memcpy(to, from, 4);
  std::memcpy(to, from, 3);  // nothing comes after the last
}

std::size_t most_slots() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  return static_cast<std::size_t>(std::max(most, 256));  // which ES 3 promises
}

}  // namespace

std::size_t PictureCache::bytes_of(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
}

void PictureCache::begin_view(std::size_t pictures, int width, int height) {
  slots_.begin_view();
  if (pictures <= slots_.size() && width <= width_ && height <= height_) return;
  width = std::max(width, width_);
  height = std::max(height, height_);
  const std::size_t in_budget = std::min(budget_bytes_ / bytes_of(width, height), most_slots());
  // Beyond the budget in steps, or each of a few more pictures would have all uploaded again.
  allocate(pictures <= in_budget ? in_budget : std::bit_ceil(pictures), width, height);
}

void PictureCache::allocate(std::size_t slots, int width, int height) {
  texture_ = gl::Texture();  // frees the old one before the new one is needed
  texture_ = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  gl::forget_errors();
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, width, height, static_cast<GLsizei>(slots));
  const bool failed = glGetError() != GL_NO_ERROR;
  slots_.reset(failed ? 0 : slots);
  width_ = failed ? 0 : width;
  height_ = failed ? 0 : height;
  if (failed) {
    throw config::InputError("the GPU has no room for " + std::to_string(slots) + " pictures of " +
                             std::to_string(width) + "x" + std::to_string(height) +
                             " pixels; a smaller render.texture_mb or render.k needs less");
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
  spread(picture, rgba_);
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(slot), picture.width(),
                  picture.height(), 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
}

}  // namespace lumibox::render
