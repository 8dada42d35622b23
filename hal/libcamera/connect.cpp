#include "hal/libcamera/connect.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

#include "config/error_text.h"
#include "hal/live/options.h"

namespace lumibox::hal::libcam {
namespace {

bool is_number(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
}

/// Those that go by the name: by their number in the list, whatever digits there are in ids; by
/// their whole id; or by a part of what they are called.
std::vector<CameraName> meant_by(const std::string& name, const std::vector<CameraName>& all) {
  std::vector<CameraName> meant;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const CameraName& camera = all[i];
    if (camera.id == name) return {camera};
    const bool fits = is_number(name)
                          ? name == std::to_string(i)
                          : name == "auto" || live::contains_in_any_case(camera.id, name) ||
                                live::contains_in_any_case(camera.model, name);
    if (fits) meant.push_back(camera);
  }
  return meant;
}

/// Not of odd sizes without steps, nor of those beyond all reason: what is nearest is another then.
bool has(const Offer& offer, int width, int height) {
  const auto is_within = [](int side, std::uint32_t least, std::uint32_t most) {
    return std::cmp_less_equal(least, side) && std::cmp_less_equal(side, most);
  };
  return is_within(width, offer.least.width, offer.most.width) &&
         is_within(height, offer.least.height, offer.most.height);
}

/// The rate wished for, as near as the camera can keep to it; 0 / 0 if it cannot be told.
live::Interval interval_of(const Abilities& abilities, double rate_hz) {
  if (!abilities.frame_duration_us) return {};
  const auto [least, most] = *abilities.frame_duration_us;
  const std::int64_t duration_us =
      std::clamp<std::int64_t>(std::llround(1e6 / rate_hz), least, most);
  return {static_cast<std::uint32_t>(duration_us), 1'000'000};
}

/// The layout, or why there is none.
std::variant<live::Layout, std::string> set_mode(OpenCamera& camera, const live::Mode& mode) {
  const std::string asked =
      fmt::format("{} {}x{}", live::name_of(mode.format), mode.width, mode.height);
  const auto answer = camera.configure(mode);
  if (const auto* error = std::get_if<int>(&answer)) return refusal("refuses " + asked, *error);
  const Configured& got = std::get<Configured>(answer);
  if (got.format != mode.format || got.width != mode.width || got.height != mode.height) {
    return fmt::format("was asked for {} and gives {}x{} in {}", asked, got.width, got.height,
                       got.format ? live::name_of(*got.format) : "a format that is not read here");
  }
  return live::make_layout(mode, got.stride, got.limited_range);
}

/// A camera that is open, or why it will not do.
std::variant<Connection, std::string> set_up(Connection found, const live::Wish& wish) {
  const std::vector<live::Mode> modes = list_modes(*found.camera, wish);
  const auto mode = live::decide(modes, wish);
  if (const auto* fault = std::get_if<std::string>(&mode)) return found.name() + ": " + *fault;
  const auto layout = set_mode(*found.camera, std::get<live::Mode>(mode));
  if (const auto* fault = std::get_if<std::string>(&layout)) return found.name() + ": " + *fault;
  found.layout = std::get<live::Layout>(layout);
  found.abilities = found.camera->abilities();
  found.layout.mode.interval = interval_of(found.abilities, wish.rate_hz);
  found.offer = live::offer_of(modes);
  return found;
}

}  // namespace

std::string name_of(const CameraName& identity) {
  return identity.model == identity.id ? identity.id
                                       : fmt::format("{} ({})", identity.model, identity.id);
}

std::string Connection::name() const {
  return name_of(identity);
}

std::vector<live::Mode> list_modes(OpenCamera& camera, const live::Wish& wish) {
  std::vector<live::Mode> modes;
  for (const Offer& offer : camera.offers()) {
    // Of sizes in steps of one, every second can be read.
    const auto nearest = [](int wished, std::uint32_t least, std::uint32_t most,
                            std::uint32_t step) {
      return live::nearest_on_grid(wished, least + (step == 1 ? least % 2 : 0), most,
                                   step == 1 ? 2 : step);
    };
    const int width = nearest(wish.width, offer.least.width, offer.most.width, offer.step.width);
    const int height =
        nearest(wish.height, offer.least.height, offer.most.height, offer.step.height);
    if (live::is_readable_size(width, height) && has(offer, width, height)) {
      modes.push_back({offer.format, width, height, {}});
    }
  }
  return modes;
}

std::variant<Connection, std::string> connect(CameraSystem& system, const Request& request) {
  const std::vector<CameraName> all = system.cameras();
  std::string reason;
  for (const CameraName& identity : meant_by(request.name, all)) {
    Opened opened = system.open(identity.id);
    if (!opened.camera) {
      reason = refusal(name_of(identity), opened.error);
      continue;
    }
    auto found = set_up(Connection{std::move(opened.camera), identity, {}, {}, {}}, request.wish);
    if (std::holds_alternative<Connection>(found)) return found;
    reason = std::get<std::string>(found);
  }
  if (!reason.empty()) return reason;
  if (all.empty()) return std::string("libcamera finds no camera");
  std::string text = "libcamera finds no camera \"" + request.name + "\"; it has ";
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += fmt::format("{}{}: {}", i == 0 ? "" : ", ", i, name_of(all[i]));
  }
  return text;
}

Request again(const Request& request, const Connection& connection) {
  return {connection.identity.id, live::again(request.wish, connection.layout.mode)};
}

std::string refusal(const std::string& what, int error) {
  const char* hint = error == EBUSY    ? "; is another program using it?"
                     : error == EACCES ? "; is the user in the group video?"
                                       : "";
  return what + ": " + config::error_text(error) + hint;
}

}  // namespace lumibox::hal::libcam
