#pragma once

#include <cstdint>
#include <vector>

namespace lumibox::hal {

/// The five buttons of the box, as printed beside them; docs/using.md says what each does when.
enum class Button { Main, Review, Plus, Minus, Wipe };

enum class ButtonAction { Pressed, Released };

struct ButtonEvent {
  Button button = Button::Main;
  ButtonAction action = ButtonAction::Pressed;
  std::int64_t timestamp_ns = 0;  ///< when the finger moved, in Clock time
};

/// A source of debounced button edges.
class Buttons {
 public:
  virtual ~Buttons() = default;

  /// All edges since the last call, oldest first. Never blocks.
  virtual std::vector<ButtonEvent> poll() = 0;
};

}  // namespace lumibox::hal
