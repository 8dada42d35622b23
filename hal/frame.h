#pragma once

#include <cstdint>
#include <memory>

#include "hal/image.h"

namespace lumibox::hal {

/// One picture of a camera. The pictures are shared and immutable: keeping a frame keeps its
/// memory.
struct Frame {
  std::int64_t index = 0;         ///< counts the camera's pictures from 0; a gap is a dropped one
  std::int64_t timestamp_ns = 0;  ///< of the exposure's middle at the middle row, in Clock time or
                                  ///< the recording's own time
  std::shared_ptr<const Image> color;  ///< three channels
  std::shared_ptr<const Image> gray;   ///< one channel, same size
};

}  // namespace lumibox::hal
