#include "hal/gpiod/gpiod_buttons.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <utility>

#include "config/error.h"
#include "config/error_text.h"
#include "config/log.h"
#include "hal/merged_buttons.h"

namespace lumibox::hal {
namespace {

Bias bias_named(const std::string& name) {
  if (name == "pull-up") {
    return Bias::PullUp;
  }
  if (name == "pull-down") {
    return Bias::PullDown;
  }
  return name == "disabled" ? Bias::Disabled : Bias::AsIs;
}

}  // namespace

GpiodButtons::GpiodButtons(const config::Gpio& options, double stuck_s, const Clock& clock)
    : clock_(clock), guard_(stuck_s) {
  const std::array<std::string, 5> lines = {options.main, options.review, options.plus,
                                            options.minus, options.wipe};
  for (const Button button : kAllButtons) {
    const std::string& line = lines.at(index_of(button));
    if (!line.empty()) {
      add(button, options, line);
    }
  }
  if (switches_.empty()) {
    throw config::InputError(
        "devices.buttons: gpio, but no button has a line; expected one at least of gpio.main, "
        "gpio.review, gpio.plus, gpio.minus and gpio.wipe");
  }
}

void GpiodButtons::add(Button button, const config::Gpio& options, const std::string& line) {
  const std::string option = "gpio." + name_of(button);
  const LineRequest request{option, line, options.active_low, bias_named(options.bias)};
  GpioInput input(request);
  const std::optional<LineReading> start = input.read();
  if (!start) {
    throw not_given(request, errno, /*user=*/nullptr);
  }
  if (start->active) {
    guard_.held_at_start(button, clock_.now_ns());
  }
  const auto quiet_ns = static_cast<std::int64_t>(std::llround(options.debounce_ms * 1e6));
  switches_.push_back({button, std::move(input), Debouncer(quiet_ns, start->active)});
}

std::vector<ButtonEvent> GpiodButtons::poll() {
  std::vector<ButtonEvent> edges;
  for (Switch& contact : switches_) {
    if (contact.line) {
      read(contact, edges);
    }
  }
  return guard_.pass(edges, clock_.now_ns());
}

void GpiodButtons::read(Switch& contact, std::vector<ButtonEvent>& edges) {
  const std::optional<LineReading> reading = contact.line->read();
  if (!reading) {
    lose(contact, config::error_text(errno), edges);
    return;
  }
  for (const LineEdge& edge : contact.debouncer.update(*reading, clock_.now_ns())) {
    edges.push_back({contact.button, edge.active ? ButtonAction::Pressed : ButtonAction::Released,
                     edge.timestamp_ns});
  }
}

/// Its chip was unplugged: nobody holds the button any more.
void GpiodButtons::lose(Switch& contact, const std::string& why, std::vector<ButtonEvent>& edges) {
  contact.line.reset();
  const std::string what = "the line of " + name_of(contact.button) + " is gone";
  config::log_error(what + ": " + why);
  gone_ = joined({gone_, what});
  if (contact.debouncer.active()) {
    edges.push_back({contact.button, ButtonAction::Released, clock_.now_ns()});
  }
}

std::optional<std::string> GpiodButtons::error() const {
  return joined({gone_, guard_.error()});
}

}  // namespace lumibox::hal
