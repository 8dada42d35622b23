#include "hal/live/frame_slot.h"

#include <utility>

namespace lumibox::hal::live {

void FrameSlot::put(RawPicture raw) {
  const std::lock_guard lock(mutex_);
  displace();
  raw_ = std::move(raw);
}

void FrameSlot::count_dropped(std::int64_t pictures) {
  const std::lock_guard lock(mutex_);
  counters_.dropped += pictures;
}

void FrameSlot::decode_ahead() {
  RawPicture raw;
  {
    const std::lock_guard lock(mutex_);
    if (!raw_ || !loop_keeps_up_) return;
    raw = *std::exchange(raw_, std::nullopt);
    decoding_ = true;
  }
  std::optional<Frame> frame = decode(raw);
  {
    const std::lock_guard lock(mutex_);
    if (!frame) ++counters_.dropped;
    frame_ = std::move(frame);
    decoding_ = false;
  }
  decoded_.notify_one();
}

std::optional<Frame> FrameSlot::take() {
  std::unique_lock lock(mutex_);
  decoded_.wait(lock, [this] { return !decoding_; });
  std::optional<Frame> frame = std::exchange(frame_, std::nullopt);
  if (std::optional<RawPicture> raw = std::exchange(raw_, std::nullopt)) {
    lock.unlock();
    frame = decode(*raw);
    lock.lock();
    if (!frame) ++counters_.dropped;
  }
  if (frame) {
    ++counters_.delivered;
    loop_keeps_up_ = !std::exchange(displaced_, false);
  }
  return frame;
}

void FrameSlot::clear() {
  const std::lock_guard lock(mutex_);
  displace();
  raw_.reset();
  displaced_ = false;
}

CameraCounters FrameSlot::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

void FrameSlot::displace() {
  if (!raw_ && !frame_) return;
  ++counters_.dropped;
  displaced_ = true;
  frame_.reset();
}

}  // namespace lumibox::hal::live
