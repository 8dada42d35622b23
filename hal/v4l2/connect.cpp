#include "hal/v4l2/connect.h"

#include <fmt/core.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <utility>

#include "hal/live/options.h"
#include "hal/live/refusal.h"
#include "hal/v4l2/modes.h"

namespace lumibox::hal::v4l2 {
namespace {

/// Of a field that need not end with a zero.
template <std::size_t n>
std::string text_of(const __u8 (&field)[n]) {
  const auto* begin = reinterpret_cast<const char*>(field);
  return {begin, std::find(begin, begin + n, '\0')};
}

bool is_path(const std::string& name) {
  return name.starts_with('/');
}

/// A device that is open, or why it will not do.
std::variant<Connection, std::string> set_up(Connection camera, const Request& request) {
  const std::optional<Identity> identity = identify(*camera.device);
  if (!identity) return camera.path + ": no camera that streams";
  camera.identity = *identity;
  if (request.card && *request.card != identity->card) {
    return fmt::format("{}: expected {}", camera.name(), *request.card);
  }
  const std::vector<live::Mode> modes = list_modes(*camera.device, request.wish);
  const auto mode = live::decide(modes, request.wish);
  if (const auto* fault = std::get_if<std::string>(&mode)) return camera.name() + ": " + *fault;
  auto layout = set_mode(*camera.device, std::get<live::Mode>(mode));
  if (const auto* fault = std::get_if<std::string>(&layout)) return camera.name() + ": " + *fault;
  camera.layout = std::get<live::Layout>(std::move(layout));
  camera.offer = live::offer_of(modes);
  return camera;
}

std::variant<Connection, std::string> try_path(VideoSystem& system, const std::string& path,
                                               const Request& request) {
  Opened opened = system.open(path);
  if (!opened.device) return live::refusal(path, opened.error);
  return set_up(Connection{std::move(opened.device), path, {}, {}, {}}, request);
}

/// Whether a node's camera goes by the name that is asked for.
bool is_meant(VideoDevice& device, const Request& request) {
  const std::optional<Identity> identity = identify(device);
  return identity && (!request.card || *request.card == identity->card) &&
         (request.name == "auto" || live::contains_in_any_case(identity->card, request.name));
}

}  // namespace

std::optional<Identity> identify(VideoDevice& device) {
  v4l2_capability capability{};
  if (device.ioctl(VIDIOC_QUERYCAP, &capability) != 0) return std::nullopt;
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                ? capability.device_caps
                                : capability.capabilities;
  constexpr std::uint32_t kNeeded = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((can & kNeeded) != kNeeded) return std::nullopt;
  return Identity{text_of(capability.card), text_of(capability.driver),
                  text_of(capability.bus_info)};
}

std::variant<Connection, std::string> connect(VideoSystem& system, const Request& request) {
  if (is_path(request.name)) return try_path(system, request.name, request);
  std::string reason;
  for (const Node& node : system.nodes()) {
    Opened opened = system.open(node.path);
    if (!opened.device) {
      reason = live::refusal(node.path, opened.error);
      continue;
    }
    if (!is_meant(*opened.device, request)) continue;
    auto found = set_up(Connection{std::move(opened.device), node.path, {}, {}, {}}, request);
    if (std::holds_alternative<Connection>(found)) return found;
    reason = std::get<std::string>(found);
  }
  if (!reason.empty()) return reason;
  return request.name == "auto" ? std::string("no camera found")
                                : "no camera named \"" + request.name + "\" found";
}

Request again(const Request& request, const Connection& connection) {
  return {request.name, live::again(request.wish, connection.layout.mode),
          connection.identity.card};
}

}  // namespace lumibox::hal::v4l2
