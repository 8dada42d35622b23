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

/// True if the appeal is beyond the limits too.
bool disagrees(const Judged& judged, const Limits& limits);

}  // namespace lumibox::render
