#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "hal/camera.h"
#include "hal/live/pictures.h"

namespace lumibox::hal::live {

/// The mailbox between the camera's thread, which puts, and the loop, which takes: of what is put
/// only the newest stays, and what it displaces is counted.
///
/// Decoding is done on the camera's thread, beside the loop, as long as the loop takes each picture
/// before the next one comes. A loop that is slower than that would have pictures decoded which it
/// never sees, at the cost of its own time: then the picture is decoded when it is taken.
class FrameSlot {
 public:
  void put(RawPicture raw);

  /// Of a picture that never came this far.
  void count_dropped(std::int64_t pictures);

  /// Decodes what was put, if the loop keeps up. By whoever puts.
  void decode_ahead();

  /// The newest picture not taken yet; waits for one that is being decoded ahead, since without it
  /// the loop would see that a tick later. One that turns out to be damaged is counted as dropped.
  std::optional<Frame> take();

  /// Forgets, and counts, what has not been taken.
  void clear();

  CameraCounters counters() const;

 private:
  void displace();

  mutable std::mutex mutex_;
  std::condition_variable decoded_;
  bool decoding_ = false;          ///< ahead; take() waits for it
  std::optional<RawPicture> raw_;  ///< either this
  std::optional<Frame> frame_;     ///< or this
  bool displaced_ = false;         ///< something, since the last picture was taken
  bool loop_keeps_up_ = true;
  CameraCounters counters_;
};

}  // namespace lumibox::hal::live
