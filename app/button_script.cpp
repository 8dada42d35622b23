#include "app/button_script.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "config/error.h"
#include "config/input_file.h"

namespace lumibox::app {
namespace {

std::optional<hal::Button> button_named(const std::string& name) {
  const auto* const button = std::ranges::find(hal::kAllButtons, name, hal::name_of);
  return button == hal::kAllButtons.end() ? std::nullopt : std::optional(*button);
}

struct ScriptLine {
  double time_s = 0.0;
  Gesture gesture;
};

/// None for a line that is not `seconds button [long]`.
std::optional<ScriptLine> parse_line(const std::string& text) {
  std::istringstream words(text);
  ScriptLine line;
  std::string button_name;
  if (!(words >> line.time_s >> button_name) || !(line.time_s >= 0.0) || line.time_s > 1e6) {
    return std::nullopt;
  }
  const auto button = button_named(button_name);
  std::string press;
  words >> press;
  std::string rest;
  if (!button || (!press.empty() && press != "long") || words >> rest) {
    return std::nullopt;
  }
  line.gesture = {*button, press.empty() ? Press::Short : Press::Long};
  return line;
}

}  // namespace

std::vector<hal::ButtonEvent> press_at(double time_s, const Gesture& gesture, double long_press_s) {
  const double held_s = (gesture.press == Press::Long ? 1.2 : 0.2) * long_press_s;
  const auto ns = [](double s) { return static_cast<std::int64_t>(std::llround(s * 1e9)); };
  return {{gesture.button, hal::ButtonAction::Pressed, ns(time_s)},
          {gesture.button, hal::ButtonAction::Released, ns(time_s + held_s)}};
}

std::vector<hal::ButtonEvent> read_button_script(const std::filesystem::path& file,
                                                 double long_press_s) {
  std::istringstream stream(config::read_text(file));
  std::vector<hal::ButtonEvent> events;
  std::map<hal::Button, std::int64_t> released_ns;
  double last_s = 0.0;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    text = text.substr(0, text.find('#'));
    if (text.find_first_not_of(" \t\r") == std::string::npos) {
      continue;
    }
    const auto line = parse_line(text);
    if (!line) {
      throw config::InputError(file, number,
                               "found \"" + text +
                                   "\"; expected `seconds button [long]` with button main, "
                                   "review, plus, minus or wipe");
    }
    if (line->time_s < last_s) {
      throw config::InputError(file, number, "the time goes back");
    }
    last_s = line->time_s;
    const auto press = press_at(line->time_s, line->gesture, long_press_s);
    const auto before = released_ns.find(line->gesture.button);
    if (before != released_ns.end() && press.front().timestamp_ns < before->second) {
      throw config::InputError(file, number,
                               hal::name_of(line->gesture.button) + " is still held, until " +
                                   std::to_string(1e-9 * static_cast<double>(before->second)) +
                                   " s; expected a later press");
    }
    released_ns[line->gesture.button] = press.back().timestamp_ns;
    events.insert(events.end(), press.begin(), press.end());
  }
  return events;
}

}  // namespace lumibox::app
