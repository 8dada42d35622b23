#pragma once

#include <map>

#include "config/config.h"
#include "hal/buttons.h"

namespace lumibox::hal {

/// Which button a key is, by the key's code in linux/input-event-codes.h.
using KeyMap = std::map<unsigned, Button>;

/// Throws config::InputError that names the option: a key that there is not, a key of two buttons,
/// no key at all.
KeyMap key_map(const config::Evdev& options);

}  // namespace lumibox::hal
