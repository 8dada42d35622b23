#pragma once

#include <string>
#include <variant>
#include <vector>

#include "hal/live/modes.h"
#include "hal/v4l2/video_system.h"

/// What pictures a camera offers, and setting one of them.
namespace lumibox::hal::v4l2 {

/// Everything the camera offers in a format that can be read here. Where it offers any size or rate
/// in a range, the one nearest to the wish stands for all. Bounded, whatever the driver answers: so
/// many entries, and no side over live::kLargestSide.
std::vector<live::Mode> list_modes(VideoDevice& device, const live::Wish& wish);

/// Sets a mode, and checks what became of it. The reason if the camera refuses or gives another
/// size or format, or pictures in two halves (interlaced); another rate is taken as it is.
std::variant<live::Layout, std::string> set_mode(VideoDevice& device, const live::Mode& mode);

}  // namespace lumibox::hal::v4l2
