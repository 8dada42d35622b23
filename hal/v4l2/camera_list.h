#pragma once

#include <string>

#include "hal/v4l2/video_system.h"

namespace lumibox::hal {

/// Every camera there is, for a person: what it is called, the formats, sizes and rates that can be
/// used, and what can be adjusted about it. Cameras that cannot be opened are there with the
/// reason; empty if there is none.
std::string list_cameras(v4l2::VideoSystem& system);

}  // namespace lumibox::hal
