#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lumibox::hal {

/// The five buttons of the box, as printed beside them; docs/using.md says what each does when.
enum class Button { Main, Review, Plus, Minus, Wipe };

inline constexpr std::array<Button, 5> kAllButtons = {Button::Main, Button::Review, Button::Plus,
                                                      Button::Minus, Button::Wipe};

constexpr std::size_t index_of(Button button) {
  return static_cast<std::size_t>(button);
}

/// As scripts and the configuration name them.
inline std::string name_of(Button button) {
  constexpr std::array<const char*, 5> kNames = {"main", "review", "plus", "minus", "wipe"};
  return kNames.at(index_of(button));
}

enum class ButtonAction { Pressed, Released };

struct ButtonEvent {
  Button button = Button::Main;
  ButtonAction action = ButtonAction::Pressed;
  std::int64_t timestamp_ns = 0;  ///< when the finger moved, in Clock time

  bool operator==(const ButtonEvent&) const = default;
};

/// A source of debounced button edges. All backends pass tests/hal/buttons_contract_test.cpp.
class Buttons {
 public:
  virtual ~Buttons() = default;

  /// All edges since the last call, oldest first. Those of one button alternate, beginning with
  /// Pressed, and are in order over all calls; one of another button may come a call later than a
  /// younger one, if its switch bounced for longer. Never blocks.
  virtual std::vector<ButtonEvent> poll() = 0;

  /// What is wrong with a button or its device, for the screen; none if nothing is. It goes on
  /// working, or comes back, by itself.
  virtual std::optional<std::string> error() const = 0;
};

}  // namespace lumibox::hal
