#include "hal/libcamera/connect.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/live/options.h"
#include "hal/live/refusal.h"

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
  const auto [least, most] = abilities.frame_duration_us.value_or(std::pair(0, 0));
  if (least <= 0 || most < least) return {};
  const std::int64_t wished_us = std::llround(1e6 / rate_hz);
  return {static_cast<std::uint32_t>(std::clamp(wished_us, least, most)), 1'000'000};
}

bool will_do(const Configured& got, const live::Mode& asked, const Request& request) {
  const bool same_format = got.format == asked.format;
  const bool same_size = got.width == asked.width && got.height == asked.height;
  const bool any_format = !request.wish.format && !request.mode;
  const bool any_size = !request.wish.exact_size && !request.mode;
  return got.format && live::is_readable_size(got.width, got.height) &&
         (same_format || any_format) && (same_size || any_size);
}

/// What the camera made of a mode, or why that is of no use. It may change sizes to what its signal
/// processor can do.
std::variant<live::Layout, std::string> set_mode(OpenCamera& camera, const live::Mode& mode,
                                                 const Request& request) {
  const std::string asked =
      fmt::format("{} {}x{}", live::name_of(mode.format), mode.width, mode.height);
  const auto answer = camera.configure(mode);
  if (const auto* error = std::get_if<int>(&answer))
    return live::refusal("refuses " + asked, *error);
  const Configured& got = std::get<Configured>(answer);
  if (!will_do(got, mode, request)) {
    return fmt::format("was asked for {} and gives {}x{} in {}", asked, got.width, got.height,
                       got.format ? live::name_of(*got.format) : "a format that is not read here");
  }
  return live::make_layout({*got.format, got.width, got.height, {}}, got.stride, got.limited_range);
}

/// A camera that is open, or why it will not do.
std::variant<Connection, std::string> set_up(Connection found, const Request& request) {
  const std::vector<live::Mode> modes = list_modes(*found.camera, request.wish);
  const std::variant<live::Mode, std::string> mode =
      request.mode ? *request.mode : live::decide(modes, request.wish);
  if (const auto* fault = std::get_if<std::string>(&mode)) return found.name() + ": " + *fault;
  const auto layout = set_mode(*found.camera, std::get<live::Mode>(mode), request);
  if (const auto* fault = std::get_if<std::string>(&layout)) return found.name() + ": " + *fault;
  found.layout = std::get<live::Layout>(layout);
  found.abilities = found.camera->abilities();
  found.layout.mode.interval = interval_of(found.abilities, request.wish.rate_hz);
  found.offer = modes.empty() ? std::string() : live::offer_of(modes);
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
      reason = live::refusal(name_of(identity), opened.error);
      continue;
    }
    auto found = set_up(Connection{std::move(opened.camera), identity, {}, {}, {}}, request);
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
  return {connection.identity.id, request.wish, connection.layout.mode};
}

}  // namespace lumibox::hal::libcam
