#pragma once

#include <cstdint>
#include <vector>

namespace lumibox::hal {

/// A key of a window went down or up.
struct KeyEdge {
  unsigned code = 0;  ///< in linux/input-event-codes.h
  bool down = false;
  std::int64_t timestamp_ns = 0;  ///< Clock time
};

/// From the window, which adds to its end, to its buttons, which empty it; on one thread.
using KeyEdges = std::vector<KeyEdge>;

}  // namespace lumibox::hal
