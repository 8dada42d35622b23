#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hal/image.h"
#include "lightfield/photo.h"
#include "render/gl.h"
#include "render/texture_slots.h"

namespace lumibox::render {

/// Pictures on the GPU: the slots of one texture array, each with one picture in its first corner.
/// When all slots are taken the one unused for longest is overwritten, so the memory is bounded
/// however many perspectives are recorded. A picture is told by the object, not by an id.
class PictureCache {
 public:
  /// Keeps as many pictures as fit into `budget_bytes`, or those of one view if they take more.
  explicit PictureCache(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  /// Starts a view of at most `pictures` pictures of at most this size: what was handed out before
  /// may be overwritten. If they do not fit, the array grows and forgets what it held. Throws
  /// config::InputError if the GPU has no room.
  void begin_view(std::size_t pictures, int width, int height);

  bool holds(const std::shared_ptr<const lightfield::Photo>& picture) const {
    return slots_.holds(picture);
  }

  /// Slot of a picture, uploaded if it is not there, for which its file may be read; valid until
  /// the next begin_view(). None if the picture is lost.
  std::optional<int> slot_of(const std::shared_ptr<const lightfield::Photo>& picture);

  GLuint texture() const { return texture_.name(); }
  std::size_t slots() const { return slots_.size(); }
  int width() const { return width_; }    ///< pixels of a slot
  int height() const { return height_; }  ///< pixels of a slot

  /// That a picture of this size takes.
  static std::size_t bytes_of(int width, int height);

 private:
  void allocate(std::size_t slots, int width, int height);
  void upload(const hal::Image& picture, std::size_t slot);

  std::size_t budget_bytes_;
  gl::Texture texture_;
  int width_ = 0;
  int height_ = 0;
  TextureSlots<lightfield::Photo> slots_;
  std::vector<std::uint8_t> rgba_;  ///< of the picture being uploaded
};

}  // namespace lumibox::render
