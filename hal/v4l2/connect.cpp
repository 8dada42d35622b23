#include "hal/v4l2/connect.h"

#include <fmt/core.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <set>
#include <string_view>
#include <utility>

#include "config/error_text.h"

namespace lumibox::hal::v4l2 {
namespace {

/// Of a field that need not end with a zero.
template <std::size_t n>
std::string text_of(const __u8 (&field)[n]) {
  const auto* begin = reinterpret_cast<const char*>(field);
  return {begin, std::find(begin, begin + n, '\0')};
}

bool contains_in_any_case(std::string_view text, std::string_view part) {
  const auto same = [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  };
  return !std::ranges::search(text, part, same).empty();
}

bool is_path(const std::string& name) {
  return name.starts_with('/');
}

std::string open_error(const std::string& path, int error) {
  const char* hint = error == EACCES ? "; is the user in the group video?" : "";
  return path + ": " + config::error_text(error) + hint;
}

std::set<std::pair<int, int>> sizes_in(const std::vector<Mode>& modes) {
  std::set<std::pair<int, int>> sizes;
  for (const Mode& mode : modes) sizes.emplace(mode.width, mode.height);
  return sizes;
}

std::string sizes_of(const std::vector<Mode>& modes) {
  std::string text;
  for (const auto& [width, height] : sizes_in(modes)) {
    text += fmt::format("{}{}x{}", text.empty() ? "" : ", ", width, height);
  }
  return text;
}

std::string formats_of(const std::vector<Mode>& modes) {
  std::set<PixelFormat> formats;
  for (const Mode& mode : modes) formats.insert(mode.format);
  std::string text;
  for (const PixelFormat format : formats)
    text += (text.empty() ? "" : ", ") + std::string(name_of(format));
  return text;
}

std::string offer_of(const std::vector<Mode>& modes) {
  const std::set<std::pair<int, int>> sizes = sizes_in(modes);
  const auto largest = std::ranges::max(sizes, {}, [](const std::pair<int, int>& size) {
    return std::int64_t{size.first} * size.second;
  });
  return fmt::format("{} in {} size{} up to {}x{}", formats_of(modes), sizes.size(),
                     sizes.size() == 1 ? "" : "s", largest.first, largest.second);
}

/// The mode to set; or why there is none that will do.
std::variant<Mode, std::string> decide(const std::vector<Mode>& modes, const Request& request) {
  if (modes.empty()) return std::string("no format that can be read here");
  const Wish& wish = request.wish;
  const std::optional<Mode> mode = choose(modes, wish);
  if (!mode) {
    return fmt::format("no {}; it has {}", name_of(*wish.format), formats_of(modes));
  }
  if (request.exact_size && (mode->width != wish.width || mode->height != wish.height)) {
    return fmt::format(
        "no pictures of {}x{}{}, which the calibration is of; it has {}", wish.width, wish.height,
        wish.format ? std::string(" in ") + name_of(*wish.format) : std::string(), sizes_of(modes));
  }
  return *mode;
}

/// A device that is open, or why it will not do.
std::variant<Connection, std::string> set_up(Connection camera, const Request& request) {
  const std::optional<Identity> identity = identify(*camera.device);
  if (!identity) return camera.path + ": no camera that streams";
  camera.identity = *identity;
  if (request.card && *request.card != identity->card) {
    return fmt::format("{}: expected {}", camera.name(), *request.card);
  }
  const std::vector<Mode> modes = list_modes(*camera.device, request.wish);
  const auto mode = decide(modes, request);
  if (const auto* fault = std::get_if<std::string>(&mode)) return camera.name() + ": " + *fault;
  auto layout = set_mode(*camera.device, std::get<Mode>(mode));
  if (const auto* fault = std::get_if<std::string>(&layout)) return camera.name() + ": " + *fault;
  camera.layout = std::get<Layout>(std::move(layout));
  camera.offer = offer_of(modes);
  return camera;
}

std::variant<Connection, std::string> try_path(VideoSystem& system, const std::string& path,
                                               const Request& request) {
  Opened opened = system.open(path);
  if (!opened.device) return open_error(path, opened.error);
  return set_up(Connection{std::move(opened.device), path, {}, {}, {}}, request);
}

/// Whether a node's camera goes by the name that is asked for.
bool is_meant(VideoDevice& device, const Request& request) {
  const std::optional<Identity> identity = identify(device);
  return identity && (!request.card || *request.card == identity->card) &&
         (request.name == "auto" || contains_in_any_case(identity->card, request.name));
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
      reason = open_error(node.path, opened.error);
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
  const Mode& mode = connection.layout.mode;
  Request same = request;
  same.wish = {mode.format, mode.width, mode.height,
               mode.interval.numerator == 0 ? request.wish.rate_hz : mode.interval.rate_hz()};
  same.exact_size = true;
  same.card = connection.identity.card;
  return same;
}

}  // namespace lumibox::hal::v4l2
