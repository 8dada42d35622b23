#pragma once

#include <filesystem>

#include "config/config.h"

namespace lumibox::app {

/// A whole session with a simulated box: somebody walks around a toy on a desk and presses buttons.
/// Everything goes the way it goes on the real box, through the hardware layer, on a clock that
/// runs as fast as the work allows. Leaves pictures of the screen and the capture in `out`, says
/// what happens on stdout, and at the end how good it was against the simulator's truth. Throws
/// config::InputError if `out` cannot be written.
void run_demo(const config::Config& config, const std::filesystem::path& out);

}  // namespace lumibox::app
