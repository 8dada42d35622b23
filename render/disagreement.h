#pragma once

#include <optional>
#include <span>
#include <vector>

#include "config/config.h"
#include "render/judge.h"

namespace lumibox::render {

/// A perspective before the court.
struct Judged {
  Judgement judgement;
  std::optional<Judgement> appeal;  ///< asked for where the judgement stands out
  double nearest = 0.0;             ///< Jury::nearest, radians
};

/// What is usual, and from where on a picture disagrees with those around it.
struct Limits {
  double shift;       ///< radians
  double difference;  ///< grey levels
  double lonely;      ///< angle to the nearest member of the jury beyond which nobody can tell
};

/// From the judgements of a capture: median and spread of each figure, so that a few bad ones do
/// not hide each other, but no less than the options say. None of fewer than six that can be told.
std::optional<Limits> limits_of(std::span<const Judged> judged, const config::Quality& options);

/// True if a judgement is beyond the limits and an appeal would tell.
bool stands_out(const Judged& judged, const Limits& limits);

/// How many times as large as the limits the appeal is, by the worse figure; 0 for what does not
/// stand out or has not been heard. Above 1 it disagrees too.
double severity(const Judged& judged, const Limits& limits);

/// A picture that disagrees is excused if one of its jury does so much more severely, by this
/// factor: that one is the likely cause, and it is told first.
inline constexpr double kCause = 2.0;

}  // namespace lumibox::render
