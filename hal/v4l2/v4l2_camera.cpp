#include "hal/v4l2/v4l2_camera.h"

#include <string>
#include <utility>
#include <variant>

#include "config/error.h"
#include "hal/v4l2/v4l2_device.h"

namespace lumibox::hal {
namespace {

v4l2::Connection connect_or_throw(v4l2::VideoSystem& system, const v4l2::Request& request) {
  auto found = v4l2::connect(system, request);
  if (const auto* fault = std::get_if<std::string>(&found)) {
    throw config::Unavailable("devices.camera: " + *fault);
  }
  return std::get<v4l2::Connection>(std::move(found));
}

live::Prepared prepare(const CameraOptions& options, std::unique_ptr<v4l2::VideoSystem> system) {
  const v4l2::Request request{options.device, live::wish_of(options), {}};
  v4l2::Connection connection = connect_or_throw(*system, request);
  v4l2::Request again = v4l2::again(request, connection);
  const live::Mode mode = connection.layout.mode;
  live::Prepared prepared;
  prepared.profile = live::profile_of(options, mode);
  prepared.introduction = live::introduction_of(options, connection.name(), connection.offer, mode);
  prepared.settings = live::settings_of(options, mode);
  prepared.device =
      std::make_unique<v4l2::V4l2Device>(std::move(system), std::move(again), std::move(connection),
                                         v4l2::power_line_setting(options.wishes.power_line));
  return prepared;
}

}  // namespace

V4l2Camera::V4l2Camera(const CameraOptions& options, const Clock& clock,
                       std::unique_ptr<v4l2::VideoSystem> system, Service service)
    : LiveCamera(prepare(options, std::move(system)), clock, service) {}

}  // namespace lumibox::hal
