#include "hal/kms/rotation.h"

#include <algorithm>
#include <cmath>

namespace lumibox::hal::kms {

std::optional<Rotation> rotation_of(int degrees) {
  switch (degrees) {
    case 0:
      return Rotation::None;
    case 90:
      return Rotation::Quarter;
    case 180:
      return Rotation::Half;
    case 270:
      return Rotation::ThreeQuarters;
    default:
      return std::nullopt;
  }
}

Size turned(Size size, Rotation rotation) {
  const bool on_its_side = rotation == Rotation::Quarter || rotation == Rotation::ThreeQuarters;
  return on_its_side ? Size{size.height, size.width} : size;
}

Area placed(Size picture, Rotation rotation, Size panel) {
  const Size upright = turned(picture, rotation);
  const double scale = std::min(static_cast<double>(panel.width) / upright.width,
                                static_cast<double>(panel.height) / upright.height);
  const auto scaled = [&](int side, int room) {
    return std::clamp(static_cast<int>(std::lround(scale * side)), 1, room);
  };
  const Size size{scaled(upright.width, panel.width), scaled(upright.height, panel.height)};
  return {(panel.width - size.width) / 2, (panel.height - size.height) / 2, size};
}

std::array<float, 4> picture_from_panel(Rotation rotation) {
  // Turned clockwise by a quarter, the picture's top (0, 1) is the panel's right (1, 0).
  switch (rotation) {
    case Rotation::None:
      break;
    case Rotation::Quarter:
      return {0.0F, 1.0F, -1.0F, 0.0F};
    case Rotation::Half:
      return {-1.0F, 0.0F, 0.0F, -1.0F};
    case Rotation::ThreeQuarters:
      return {0.0F, -1.0F, 1.0F, 0.0F};
  }
  return {1.0F, 0.0F, 0.0F, 1.0F};
}

}  // namespace lumibox::hal::kms
