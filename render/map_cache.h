#pragma once

#include <memory>
#include <vector>

#include "render/depth_map.h"
#include "render/gl.h"
#include "render/texture_slots.h"

namespace lumibox::render {

/// Depth maps on the GPU, as PictureCache has pictures: the slots of one texture array, eight bits
/// per sample, as a share of the map's largest inverse depth.
class MapCache {
 public:
  /// Starts a view of these maps: what was handed out before may be overwritten. Null ones count
  /// for nothing.
  void begin_view(const std::vector<const DepthMap*>& maps);

  struct Slot {
    int index = 0;
    double largest = 0.0;  ///< inverse depth, of which the samples are shares
  };
  /// Where a map is, uploaded if it is not there; valid until the next begin_view().
  Slot slot_of(const std::shared_ptr<const DepthMap>& map);

  GLuint texture() const { return texture_.name(); }
  int width() const { return width_; }    ///< samples of a slot
  int height() const { return height_; }  ///< samples of a slot

 private:
  void upload(const DepthMap& map, std::size_t slot);

  gl::Texture texture_;
  int width_ = 0;
  int height_ = 0;
  TextureSlots<DepthMap> slots_;
  std::vector<double> largest_;       ///< by slot
  std::vector<std::uint8_t> shares_;  ///< of the map being uploaded
};

}  // namespace lumibox::render
