#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/live/device.h"
#include "hal/v4l2/buffers.h"
#include "hal/v4l2/connect.h"
#include "hal/v4l2/controls.h"

namespace lumibox::hal::v4l2 {

/// A webcam that was connected once, and is connected again in the same mode whenever it is opened.
class V4l2Device : public live::Device {
 public:
  /// `power_line`: none leaves it as the camera has it.
  V4l2Device(std::unique_ptr<VideoSystem> system, Request request, Connection connection,
             const std::optional<Setting>& power_line);

  std::optional<std::string> open() override;
  bool is_open() const override { return connection_.device != nullptr; }
  void close() override;
  std::string name() const override { return connection_.name(); }
  const live::Layout& layout() const override { return connection_.layout; }

  std::optional<std::string> begin() override;
  bool is_streaming() const override { return ring_.has_value(); }
  void end() override { ring_.reset(); }
  Taken take() override;
  std::optional<std::string> give_back(const live::Filled& filled) override;
  std::optional<std::string> loss() override;
  int poll_fd() const override { return ring_ ? connection_.device->poll_fd() : -1; }

  bool changed() override { return system_->changed(); }
  int watch_fd() const override { return system_->watch_fd(); }

  void update_hold(bool wanted) override;
  void forget_hold() override;

 private:
  void free_what_was_left_held();
  void say_faults(const std::vector<std::string>& faults) const;

  std::unique_ptr<VideoSystem> system_;
  Request request_;
  Connection connection_;
  std::optional<Setting> power_line_;
  std::optional<BufferRing> ring_;
  ExposureHold hold_;
  std::optional<bool> hold_done_;  ///< what was wanted when this device's controls were set
};

}  // namespace lumibox::hal::v4l2
