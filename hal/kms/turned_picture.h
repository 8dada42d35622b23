#pragma once

#include <array>

#include "hal/kms/rotation.h"

namespace lumibox::hal::kms {

/// A picture of its own size that is drawn into and then put on a panel, turned and scaled. Its
/// objects are of the context that is current when it is made and must be current in every call;
/// they end with the context.
class TurnedPicture {
 public:
  /// Throws config::InputError if the driver cannot.
  explicit TurnedPicture(Size size);

  unsigned framebuffer() const { return framebuffer_; }

  /// Draws it into a framebuffer of the panel's size, black around it. Pixel for pixel if the sizes
  /// are alike, else with linear interpolation. What is bound for drawing afterwards is up to the
  /// caller; the state of blending, scissor and the like is as before.
  void put(unsigned panel_framebuffer, Size panel, Rotation rotation) const;

 private:
  Size size_;
  unsigned texture_ = 0;
  unsigned framebuffer_ = 0;
  unsigned program_ = 0;
  unsigned vertex_array_ = 0;
  int picture_from_panel_ = -1;
};

}  // namespace lumibox::hal::kms
