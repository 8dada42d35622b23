#include "hal/v4l2/camera_list.h"

#include <fmt/core.h>

#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "config/error_text.h"
#include "hal/v4l2/connect.h"
#include "hal/v4l2/controls.h"
#include "hal/v4l2/modes.h"

namespace lumibox::hal {
namespace {

/// One line of each format and size, with its rates, the fastest first.
std::string describe_modes(const std::vector<live::Mode>& modes) {
  using Picture = std::tuple<live::PixelFormat, int, int>;
  std::map<Picture, std::set<double, std::greater<>>> rates_of;
  for (const live::Mode& mode : modes) {
    rates_of[{mode.format, mode.width, mode.height}].insert(mode.interval.rate_hz());
  }
  std::string text;
  for (const auto& [picture, rates] : rates_of) {
    const auto& [format, width, height] = picture;
    std::string list;
    for (const double rate : rates) {
      if (rate > 0.0) list += fmt::format("{}{:.4g}", list.empty() ? "" : ", ", rate);
    }
    text += fmt::format("  {} {}x{}: {}\n", live::name_of(format), width, height,
                        list.empty() ? "at a rate that it does not say" : list + " Hz");
  }
  return text.empty() ? "  no format that can be read here\n" : text;
}

std::string describe_controls(const std::vector<v4l2::Control>& controls) {
  std::string text;
  for (const v4l2::Control& control : controls) {
    text += fmt::format("  {}: {} ({} to {})\n", control.name, control.value, control.least,
                        control.most);
  }
  return text;
}

/// Empty of a node that is no camera.
std::string describe(v4l2::VideoSystem& system, const v4l2::Node& node) {
  const v4l2::Opened opened = system.open(node.path);
  if (!opened.device) return node.path + ": " + config::error_text(opened.error) + "\n";
  const auto identity = v4l2::identify(*opened.device);
  if (!identity) return {};
  std::string text =
      fmt::format("{}: {} ({}, {})\n", node.path, identity->card, identity->driver, identity->bus);
  if (!node.stable_path.empty()) text += "  " + node.stable_path + "\n";
  return text + describe_modes(v4l2::list_modes(*opened.device, {})) +
         describe_controls(v4l2::list_controls(*opened.device));
}

}  // namespace

std::string list_cameras(v4l2::VideoSystem& system) {
  std::string text;
  for (const v4l2::Node& node : system.nodes()) text += describe(system, node);
  return text;
}

}  // namespace lumibox::hal
