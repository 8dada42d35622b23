#pragma once

#include <cstddef>
#include <memory>

#include "hal/image.h"
#include "hal/replay/sequence.h"

namespace lumibox::hal {

/// The pictures of a sequence, from image files or from its video.
class FrameReader {
 public:
  virtual ~FrameReader() = default;

  /// The picture of an entry; the entries must be asked for in increasing order. Throws
  /// config::InputError if it is missing, damaged, or not of the size the sequence says.
  virtual Image read(std::size_t entry) = 0;
};

/// `sequence` must outlive the reader.
std::unique_ptr<FrameReader> make_frame_reader(const Sequence& sequence);

}  // namespace lumibox::hal
