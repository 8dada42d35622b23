#include "hal/libcamera/libcamera_camera.h"

#include <fmt/core.h>

#include <utility>
#include <variant>
#include <vector>

#include "config/error.h"
#include "hal/libcamera/connect.h"
#include "hal/libcamera/libcamera_device.h"
#include "hal/live/refusal.h"

namespace lumibox::hal {
namespace {

live::Prepared prepare(const CameraOptions& options, std::unique_ptr<libcam::CameraSystem> system) {
  const libcam::Request request{options.device, live::wish_of(options), {}};
  auto found = libcam::connect(*system, request);
  if (const auto* fault = std::get_if<std::string>(&found)) {
    throw config::Unavailable("devices.camera: " + *fault);
  }
  auto connection = std::get<libcam::Connection>(std::move(found));
  libcam::Request again = libcam::again(request, connection);
  const live::Mode mode = connection.layout.mode;
  live::Prepared prepared;
  prepared.profile = live::profile_of(options, mode);
  prepared.introduction = live::introduction_of(options, connection.name(), connection.offer, mode);
  if (options.wishes.power_line != "asis") {
    prepared.introduction.warnings.emplace_back(
        "camera.power_line is for v4l2 only; this camera does as it likes");
  }
  prepared.settings = live::settings_of(options, mode);
  prepared.device = std::make_unique<libcam::LibcameraDevice>(std::move(system), std::move(again),
                                                              std::move(connection));
  return prepared;
}

std::string describe_sizes(const libcam::Offer& offer) {
  const auto& [format, least, most, step] = offer;
  if (least.width == most.width && least.height == most.height) {
    return fmt::format("  {} {}x{}\n", live::name_of(format), most.width, most.height);
  }
  return fmt::format("  {} {}x{} to {}x{}\n", live::name_of(format), least.width, least.height,
                     most.width, most.height);
}

std::string describe_abilities(const libcam::Abilities& abilities) {
  std::string text;
  const auto add = [&text](bool able, const char* what) {
    if (able) text += std::string(text.empty() ? "  can be held: " : ", ") + what;
  };
  add(abilities.focus, "focus");
  add(abilities.exposure, "exposure");
  add(abilities.white_balance, "white balance");
  if (!text.empty()) text += "\n";
  if (abilities.frame_duration_us) {
    const auto [least_us, most_us] = *abilities.frame_duration_us;
    text += fmt::format("  {:.4g} to {:.4g} Hz\n", 1e6 / static_cast<double>(most_us),
                        1e6 / static_cast<double>(least_us));
  }
  return text;
}

std::string describe(libcam::CameraSystem& system, const libcam::CameraName& camera) {
  const libcam::Opened opened = system.open(camera.id);
  if (!opened.camera) return "  " + live::refusal("cannot be opened", opened.error) + "\n";
  std::string text;
  for (const libcam::Offer& offer : opened.camera->offers()) text += describe_sizes(offer);
  if (text.empty()) text = "  no format that can be read here\n";
  return text + describe_abilities(opened.camera->abilities());
}

}  // namespace

LibcameraCamera::LibcameraCamera(const CameraOptions& options, const Clock& clock,
                                 std::unique_ptr<libcam::CameraSystem> system, Service service)
    : LiveCamera(prepare(options, std::move(system)), clock, service) {}

std::string list_cameras(libcam::CameraSystem& system) {
  std::string text;
  int number = 0;
  for (const libcam::CameraName& camera : system.cameras()) {
    text += fmt::format("libcamera:{}: {}\n", number++, libcam::name_of(camera));
    text += describe(system, camera);
  }
  return text;
}

}  // namespace lumibox::hal
