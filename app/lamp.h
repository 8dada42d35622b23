#pragma once

#include <cstdint>

namespace lumibox::app {

/// What the lamp on the box shows: lit while new views are recorded, dark for a moment after each.
class Lamp {
 public:
  /// `recording`: the box sees where it is, and the gate may open; `recorded`: it did, in this
  /// tick.
  bool is_lit(bool recording, bool recorded, std::int64_t now_ns);

 private:
  std::int64_t dark_until_ns_ = 0;
};

}  // namespace lumibox::app
