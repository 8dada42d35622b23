#include "render/map_cache.h"

#include <algorithm>

namespace lumibox::render {
namespace {

constexpr std::size_t kLeastSlots = 32;  // a view needs eight; the next view needs most of them too

}  // namespace

void MapCache::begin_view(const std::vector<const DepthMap*>& maps) {
  slots_.begin_view();
  int width = width_;
  int height = height_;
  for (const DepthMap* map : maps) {
    if (map == nullptr) continue;
    width = std::max(width, map->camera.width());
    height = std::max(height, map->camera.height());
  }
  const std::size_t slots = std::max(kLeastSlots, maps.size());
  if (width == width_ && height == height_ && slots <= slots_.size()) return;
  width_ = width;
  height_ = height;
  slots_.reset(slots);
  largest_.assign(slots, 0.0);
  texture_ = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_R8, std::max(width_, 1), std::max(height_, 1),
                 static_cast<GLsizei>(slots));
}

MapCache::Slot MapCache::slot_of(const std::shared_ptr<const DepthMap>& map) {
  const auto [slot, is_new] = slots_.place_of(map);
  if (is_new) upload(*map, slot);
  return {static_cast<int>(slot), largest_[slot]};
}

void MapCache::upload(const DepthMap& map, std::size_t slot) {
  largest_[slot] = static_cast<double>(map.largest);
  shares_.clear();
  // 65535 is 255 times 257.
  for (const int share : map.shares) {
    shares_.push_back(static_cast<std::uint8_t>((share + 128) / 257));
  }
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(slot), map.camera.width(),
                  map.camera.height(), 1, GL_RED, GL_UNSIGNED_BYTE, shares_.data());
}

}  // namespace lumibox::render
