#include "hal/libcamera/exposure_hold.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumibox::hal::libcam {
namespace {

constexpr int kTries = 3;

// Those that were on their way, and those that a sensor takes to do as it is told.
constexpr int kPicturesUntilTold = 10;

/// Sensors round exposures to rows and gains to steps of their own; 5 % are no difference that can
/// be seen. Lenses have some hundred steps between 0 and 10 dioptres or more.
bool same(double value, double held) {
  constexpr double kShare = 0.05;
  return std::abs(value - held) <= kShare * std::max(1.0, std::abs(held));
}

/// Each value that is held and that the camera gives, in turn: its name, what it is and what it
/// should be.
template <typename Visit>
void for_each_held(const Adjustments& now, const Adjustments& held, Visit visit) {
  const auto one = [&](const char* name, const auto& value, const auto& wanted) {
    if (value && wanted) visit(name, double{1} * *value, double{1} * *wanted);
  };
  one("exposure in us", now.exposure_us, held.exposure_us);
  one("gain", now.gain, held.gain);
  if (now.white_gains && held.white_gains) {
    visit("gain of red", double{(*now.white_gains)[0]}, double{(*held.white_gains)[0]});
    visit("gain of blue", double{(*now.white_gains)[1]}, double{(*held.white_gains)[1]});
  }
  one("focus in dioptres", now.lens_dioptres, held.lens_dioptres);
}

std::string differences(const Adjustments& now, const Adjustments& held) {
  std::string text;
  for_each_held(now, held, [&text](const char* name, double value, double wanted) {
    if (same(value, wanted)) return;
    text += fmt::format("{}{} is not set to {:.4g}: it is {:.4g}", text.empty() ? "" : "; ", name,
                        wanted, value);
  });
  return text;
}

std::string description(const Adjustments& held) {
  std::string text;
  for_each_held(held, held, [&text](const char* name, double value, double) {
    text += fmt::format("{}{} {:.4g}", text.empty() ? "held: " : ", ", name, value);
  });
  return text.empty() ? "held, as far as the camera can be: it does not say how it is set" : text;
}

}  // namespace

Orders ExposureHold::begin() {
  latest_.reset();
  orders_.clear();
  news_.reset();
  checking_ = held_.has_value();
  tries_ = 1;
  pictures_ = 0;
  if (!held_) return {true, {}, {}};
  orders_ = {{std::nullopt, *held_, {}}};
  return {false, *held_, {}};
}

void ExposureHold::saw(const Adjustments& adjustments) {
  latest_ = adjustments;
  ++pictures_;
  if (checking_) check();
}

void ExposureHold::want(bool hold) {
  if (hold && !held_ && latest_) {
    held_ = latest_;
    checking_ = true;
    tries_ = 0;
    order();
  } else if (!hold && held_) {
    held_.reset();
    checking_ = false;
    orders_ = {{true, {}, {}}};
  }
}

std::optional<Orders> ExposureHold::take_orders() {
  if (orders_.empty()) return std::nullopt;
  const Orders first = orders_.front();
  orders_.pop_front();
  return first;
}

std::optional<std::string> ExposureHold::take_news() {
  return std::exchange(news_, std::nullopt);
}

void ExposureHold::forget() {
  held_.reset();
  checking_ = false;
}

void ExposureHold::order() {
  orders_ = {{false, *held_, {}}, {std::nullopt, *held_, {}}};
  ++tries_;
  pictures_ = 0;
}

/// By the first picture that must have been taken as it was told: an earlier one may be so by
/// chance.
void ExposureHold::check() {
  if (pictures_ < kPicturesUntilTold) return;
  const std::string wrong = differences(*latest_, *held_);
  if (!wrong.empty() && tries_ < kTries) return order();
  checking_ = false;
  is_fault_ = !wrong.empty();
  news_ = is_fault_ ? wrong : description(*held_);
}

}  // namespace lumibox::hal::libcam
