#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/live/device.h"
#include "hal/live/frame_slot.h"
#include "hal/live/numbering.h"
#include "hal/live/recovery.h"

namespace lumibox::hal::live {

struct StreamSettings {
  std::int64_t readout_ns = 0;               ///< from the first row to the last
  std::int64_t patience_ns = 2'000'000'000;  ///< without a frame, until something is done about it
};

/// Keeps a camera streaming into a slot, whatever becomes of the camera. It never waits: somebody
/// calls service() whenever the device, or the system's watch, has something or due_ns() has come;
/// a thread, or a test with a clock of its own. All but state() and hold_exposure() is for that one
/// caller.
class Streamer {
 public:
  /// `device` and `slot` must outlive the object.
  Streamer(Device& device, FrameSlot& slot, const StreamSettings& settings);

  /// Begins the stream, its frames numbered from 0. The reason if the camera refuses.
  std::optional<std::string> start(std::int64_t now_ns);
  void stop();

  /// Does all there is to do at this time.
  void service(std::int64_t now_ns);

  /// When service() is to be called even if nothing happens.
  std::int64_t due_ns() const { return recovery_.due_ns(); }

  /// What announces work for service(); -1 while there is no device.
  int poll_fd() const { return device_.poll_fd(); }

  CameraState state() const { return state_; }

  /// From the next service() on; again after the device was opened anew.
  void hold_exposure(bool hold) { hold_wanted_ = hold; }

 private:
  /// The newest picture of those that were drained, still in the camera's buffer.
  struct Newest {
    Filled filled;
    std::int64_t index = 0;
    std::int64_t timestamp_ns = 0;
  };

  std::optional<std::string> open_and_begin(std::int64_t now_ns);
  std::optional<std::string> begin_stream();
  void drain(std::int64_t now_ns);
  bool accept(const Filled& filled, std::int64_t now_ns);
  void hand_over(std::int64_t now_ns);
  void recover(std::int64_t now_ns);
  void restart(std::int64_t now_ns);
  void reopen(std::int64_t now_ns);
  void lose(const std::string& reason, std::int64_t now_ns);
  void close_device(std::int64_t now_ns);
  void say_lost(const std::string& reason, std::int64_t now_ns);
  std::string name() const { return "camera " + device_.name(); }

  Device& device_;
  FrameSlot& slot_;
  StreamSettings settings_;
  Recovery recovery_;
  Numbering numbering_;
  Stamping stamping_;
  std::optional<Newest> newest_;
  std::int64_t lost_ns_ = 0;
  std::string reopen_fault_;  ///< why the last attempt failed; said once
  bool said_damage_ = false;
  bool said_stamps_ = false;
  std::atomic<bool> hold_wanted_ = false;
  std::atomic<CameraState> state_ = CameraState::Stopped;
};

}  // namespace lumibox::hal::live
