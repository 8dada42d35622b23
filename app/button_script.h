#pragma once

#include <filesystem>
#include <vector>

#include "app/gestures.h"
#include "hal/buttons.h"

namespace lumibox::app {

/// Edges of one press that begins at `time_s`; a long one lasts a little more than `long_press_s`,
/// a short one a fifth of it.
std::vector<hal::ButtonEvent> press_at(double time_s, const Gesture& gesture, double long_press_s);

/// Reads a script of button presses, one per line: `seconds button [long]`, the button one of main,
/// review, plus, minus, wipe; `#` begins a comment. A short press lasts a fifth of `long_press_s`.
/// Times must not go back, and a button must be up to be pressed. Throws config::InputError with
/// file and line.
std::vector<hal::ButtonEvent> read_button_script(const std::filesystem::path& file,
                                                 double long_press_s);

}  // namespace lumibox::app
