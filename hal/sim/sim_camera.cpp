#include "hal/sim/sim_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/sim/frame_renderer.h"
#include "hal/sim/scene_impl.h"
#include "hal/sim/shutter.h"

namespace lumibox::hal {

class SimCamera::Impl {
 public:
  Impl(std::shared_ptr<const Scene> scene, const Clock& clock)
      : scene_(std::move(scene)), effects_(scene_->impl().spec.effects), clock_(clock) {
    // A frame is there when its last row has been exposed and read.
    const double after_timestamp_s = 0.5 * (sim::exposure_s(effects_) + sim::readout_s(effects_));
    latency_ns_ = std::llround(after_timestamp_s * 1e9);
  }

  const config::CameraProfile& profile() const { return scene_->profile(); }
  CameraState state() const { return state_; }
  CameraCounters counters() const { return counters_; }
  const SimCost& last_cost() const { return cost_; }
  void lock_exposure(bool locked) { exposure_locked_ = locked; }

  void start() {
    renderer_ = std::make_unique<sim::FrameRenderer>(*scene_);
    start_ns_ = clock_.now_ns();
    next_ = 0;
    state_ = CameraState::Streaming;
  }

  void stop() {
    renderer_.reset();
    state_ = CameraState::Stopped;
  }

  std::optional<Frame> take_newest() {
    if (state_ != CameraState::Streaming) return std::nullopt;
    std::optional<std::int64_t> newest;
    for (const std::int64_t end = complete_frames(); next_ < end; ++next_) {
      const bool lost = sim::is_dropped(effects_, next_);
      if (lost || newest) ++counters_.dropped;
      if (!lost) newest = next_;
    }
    if (next_ == scene_->frame_count()) state_ = CameraState::Ended;
    if (!newest) return std::nullopt;
    ++counters_.delivered;
    return render(*newest);
  }

 private:
  /// How many frames have been exposed and read since start().
  std::int64_t complete_frames() const {
    const std::int64_t elapsed_ns = clock_.now_ns() - start_ns_ - latency_ns_;
    if (elapsed_ns < 0) return 0;
    const double periods = static_cast<double>(elapsed_ns) * 1e-9 * profile().fps;
    // The estimate may be off by one through rounding; timestamp_ns() decides.
    std::int64_t count = std::min(static_cast<std::int64_t>(periods), scene_->frame_count());
    while (count < scene_->frame_count() && scene_->timestamp_ns(count) <= elapsed_ns) ++count;
    return count;
  }

  Frame render(std::int64_t index) {
    Frame frame;
    frame.index = index;
    frame.timestamp_ns = start_ns_ + scene_->timestamp_ns(index);
    auto color = std::make_shared<Image>(renderer_->render(index, exposure_locked_, cost_));
    frame.gray = std::make_shared<const Image>(to_gray(*color));
    frame.color = std::move(color);
    return frame;
  }

  std::shared_ptr<const Scene> scene_;
  const sim::EffectSpecs& effects_;
  const Clock& clock_;
  std::int64_t latency_ns_ = 0;

  std::unique_ptr<sim::FrameRenderer> renderer_;  ///< only while streaming
  std::int64_t start_ns_ = 0;
  std::int64_t next_ = 0;  ///< first frame not yet looked at
  bool exposure_locked_ = false;
  CameraState state_ = CameraState::Stopped;
  CameraCounters counters_;
  SimCost cost_;
};

SimCamera::SimCamera(std::shared_ptr<const Scene> scene, const Clock& clock)
    : impl_(std::make_unique<Impl>(std::move(scene), clock)) {}

SimCamera::~SimCamera() = default;

const config::CameraProfile& SimCamera::profile() const {
  return impl_->profile();
}
void SimCamera::start() {
  impl_->start();
}
void SimCamera::stop() {
  impl_->stop();
}
std::optional<Frame> SimCamera::take_newest() {
  return impl_->take_newest();
}
CameraState SimCamera::state() const {
  return impl_->state();
}
CameraCounters SimCamera::counters() const {
  return impl_->counters();
}
void SimCamera::lock_exposure(bool locked) {
  impl_->lock_exposure(locked);
}
const SimCost& SimCamera::last_cost() const {
  return impl_->last_cost();
}

}  // namespace lumibox::hal
