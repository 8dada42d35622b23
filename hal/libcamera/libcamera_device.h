#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hal/libcamera/camera_system.h"
#include "hal/libcamera/connect.h"
#include "hal/libcamera/exposure_hold.h"
#include "hal/live/device.h"

namespace lumibox::hal::libcam {

/// A camera that was connected once, and is connected again in the same mode whenever it is opened.
class LibcameraDevice : public live::Device {
 public:
  LibcameraDevice(std::unique_ptr<CameraSystem> system, Request request, Connection connection);

  std::optional<std::string> open() override;
  bool is_open() const override { return connection_.camera != nullptr; }
  void close() override;
  std::string name() const override { return connection_.name(); }
  const live::Layout& layout() const override { return connection_.layout; }

  std::optional<std::string> begin() override;
  bool is_streaming() const override { return streaming_; }
  void end() override;
  Taken take() override;
  std::optional<std::string> give_back(const live::Filled& filled) override;
  std::optional<std::string> loss() override;
  int poll_fd() const override { return streaming_ ? connection_.camera->poll_fd() : -1; }

  bool changed() override { return system_->changed(); }
  int watch_fd() const override { return system_->watch_fd(); }

  void update_hold(bool wanted) override;
  void forget_hold() override { hold_.forget(); }

 private:
  Orders complete(Orders orders) const;
  live::Filled filled_of(const Completed& completed) const;

  std::unique_ptr<CameraSystem> system_;
  Request request_;
  Connection connection_;
  bool streaming_ = false;
  ExposureHold hold_;
};

}  // namespace lumibox::hal::libcam
