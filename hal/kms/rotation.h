#pragma once

#include <array>
#include <optional>

#include "hal/kms/mode.h"

namespace lumibox::hal::kms {

/// How far the picture is turned clockwise to stand upright on a panel that is built in turned.
enum class Rotation { None, Quarter, Half, ThreeQuarters };

/// 0, 90, 180 or 270 degrees; none for any other angle.
std::optional<Rotation> rotation_of(int degrees);

/// Of the picture that, turned, fills a panel of this size; and the other way round.
Size turned(Size size, Rotation rotation);

/// A part of the panel; pixels, from the bottom left as GL has it.
struct Area {
  int x = 0;
  int y = 0;
  Size size;
  bool operator==(const Area&) const = default;
};

/// Where a picture goes on a panel: turned, as large as possible and in the middle.
Area placed(Size picture, Rotation rotation, Size panel);

/// The 2x2 matrix, column after column, that takes a direction on the panel to one in the picture;
/// both have x right and y up.
std::array<float, 4> picture_from_panel(Rotation rotation);

}  // namespace lumibox::hal::kms
