#include "hal/replay/replay_camera.h"

#include <utility>

#include "hal/replay/frame_reader.h"

namespace lumibox::hal {

class ReplayCamera::Impl {
 public:
  Impl(Sequence sequence, const Clock& clock, Pacing pacing)
      : sequence_(std::move(sequence)), clock_(clock), pacing_(pacing) {}

  const config::CameraProfile& profile() const { return sequence_.profile; }
  CameraState state() const { return state_; }
  CameraCounters counters() const { return counters_; }

  void start() {
    reader_ = make_frame_reader(sequence_);
    start_ns_ = clock_.now_ns();
    next_ = 0;
    state_ = CameraState::Streaming;
  }

  void stop() {
    reader_.reset();
    state_ = CameraState::Stopped;
  }

  std::optional<Frame> take_newest() {
    if (state_ != CameraState::Streaming) {
      return std::nullopt;
    }
    const std::size_t due = entries_due();
    if (due == next_) {
      return std::nullopt;
    }
    const std::size_t newest = due - 1;
    counters_.dropped += static_cast<std::int64_t>(newest - next_);
    next_ = due;
    Frame frame = read(newest);
    ++counters_.delivered;
    if (next_ == sequence_.entries.size()) {
      reader_.reset();
      state_ = CameraState::Ended;
    }
    return frame;
  }

 private:
  /// Number of entries that have appeared by now, those already handed out included. Stamps are
  /// rounded and jitter: an entry counts a quarter of a period early, or a loop that ticks at the
  /// recording's own rate would miss one by a microsecond and find two at the next tick.
  std::size_t entries_due() const {
    if (pacing_ == Pacing::Lockstep) {
      return next_ + 1;
    }
    const std::int64_t first_ns = sequence_.entries.front().timestamp_ns;
    const auto tolerance_ns = static_cast<std::int64_t>(0.25e9 / sequence_.profile.fps);
    const std::int64_t elapsed_ns = clock_.now_ns() - start_ns_ + tolerance_ns;
    std::size_t due = next_;
    while (due < sequence_.entries.size() &&
           sequence_.entries[due].timestamp_ns - first_ns <= elapsed_ns) {
      ++due;
    }
    return due;
  }

  Frame read(std::size_t entry) {
    auto image = std::make_shared<const Image>(reader_->read(entry));
    Frame frame;
    frame.index = static_cast<std::int64_t>(entry);
    frame.timestamp_ns = sequence_.entries[entry].timestamp_ns;
    const bool is_gray = image->channels() == 1;
    frame.color = is_gray ? std::make_shared<const Image>(to_rgb(*image)) : image;
    frame.gray = is_gray ? image : std::make_shared<const Image>(to_gray(*image));
    return frame;
  }

  Sequence sequence_;
  const Clock& clock_;
  Pacing pacing_;
  std::unique_ptr<FrameReader> reader_;  ///< while streaming
  CameraState state_ = CameraState::Stopped;
  CameraCounters counters_;
  std::int64_t start_ns_ = 0;  ///< clock time at which the first frame appeared
  std::size_t next_ = 0;       ///< first entry that has neither been handed out nor dropped
};

ReplayCamera::ReplayCamera(Sequence sequence, const Clock& clock, Pacing pacing)
    : impl_(std::make_unique<Impl>(std::move(sequence), clock, pacing)) {}
ReplayCamera::~ReplayCamera() = default;

const config::CameraProfile& ReplayCamera::profile() const {
  return impl_->profile();
}
void ReplayCamera::start() {
  impl_->start();
}
void ReplayCamera::stop() {
  impl_->stop();
}
std::optional<Frame> ReplayCamera::take_newest() {
  return impl_->take_newest();
}
CameraState ReplayCamera::state() const {
  return impl_->state();
}
CameraCounters ReplayCamera::counters() const {
  return impl_->counters();
}

/// What is recorded cannot be changed any more.
void ReplayCamera::lock_exposure(bool /*locked*/) {}

}  // namespace lumibox::hal
