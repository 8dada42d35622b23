#pragma once

namespace lumibox::hal {

/// A lamp on the box. It is dark when it is made and when it goes.
class StatusLed {
 public:
  virtual ~StatusLed() = default;

  /// Never blocks. A lamp that no longer works stays as it is.
  virtual void light(bool lit) = 0;
};

}  // namespace lumibox::hal
