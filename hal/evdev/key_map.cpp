#include "hal/evdev/key_map.h"

#include <libevdev/libevdev.h>

#include <array>
#include <sstream>
#include <string>

#include "config/error.h"

namespace lumibox::hal {

KeyMap key_map(const config::Evdev& options) {
  const std::array<std::string, 5> keys = {options.main, options.review, options.plus,
                                           options.minus, options.wipe};
  KeyMap map;
  for (const Button button : kAllButtons) {
    const std::string option = "evdev." + name_of(button);
    std::istringstream words(keys.at(index_of(button)));
    for (std::string word; words >> word;) {
      const int code = libevdev_event_code_from_name(EV_KEY, word.c_str());
      if (code < 0) {
        throw config::InputError(option + ": no key is called \"" + word +
                                 "\"; expected names such as KEY_ENTER, with spaces between");
      }
      const auto [known, is_new] = map.emplace(static_cast<unsigned>(code), button);
      if (!is_new && known->second != button) {
        throw config::InputError(option + ": " + word + " is already evdev." +
                                 name_of(known->second) + "; expected a key of one button");
      }
    }
  }
  if (map.empty()) {
    throw config::InputError(
        "devices.buttons: evdev, but no button has a key; expected one at least of evdev.main, "
        "evdev.review, evdev.plus, evdev.minus and evdev.wipe");
  }
  return map;
}

}  // namespace lumibox::hal
