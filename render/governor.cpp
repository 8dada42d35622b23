#include "render/governor.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace lumibox::render {
namespace {

// A measurement that is higher is believed sooner than one that is lower: a late tick is seen, a
// picture that could have been a little finer is not.
constexpr double kRise = 0.8;
constexpr double kFall = 0.15;
// A better quality is taken up only if it needs clearly less than there is, and not at once:
// what changes back and forth is worse than either.
constexpr double kRoomToRise = 0.8;
constexpr int kChoicesBeforeRise = 15;
// What was too slow is thought a little faster with each choice, until it is tried again: other
// work that made it slow may be over. Half the cost in 10 s at 30 choices a second.
constexpr double kForget = 0.9977;
constexpr double kBudgetRise = 0.1;

}  // namespace

std::string description(const Effort& quality, int k) {
  static constexpr const char* kNames[] = {"planes", "focal plane", "shape"};
  return fmt::format("{}, {:.2f} of the size, {} views",
                     kNames[static_cast<std::size_t>(quality.geometry)], quality.scale,
                     std::max(1, static_cast<int>(std::lround(quality.k_share * k))));
}

Settings at_effort(Settings settings, const Effort& quality) {
  if (settings.k > 0) {
    settings.k = std::max(1, static_cast<int>(std::lround(quality.k_share * settings.k)));
  }
  return settings;
}

std::size_t Governor::kind_of(const Wish& wish) {
  if (wish.geometry == Geometry::Mesh) return 2;
  return wish.aperture == Aperture::Wide ? 1 : 0;
}

Governor::Ladder Governor::make_ladder(std::size_t kind) {
  // A small picture enlarged is liked better than one with jumps or ghosts; the shape at half the
  // size is likelier than planes at the full one (docs/benchmarks.md).
  switch (kind) {
    case 0:
      return {{{Geometry::Plane, 1.0, 1.0}, 1.0, {}},
              {{Geometry::Plane, 0.71, 1.0}, 0.5, {}},
              {{Geometry::Plane, 0.5, 1.0}, 0.27, {}},
              {{Geometry::Plane, 0.35, 1.0}, 0.15, {}}};
    case 1:
      return {{{Geometry::Plane, 1.0, 1.0}, 1.0, {}},   {{Geometry::Plane, 0.71, 1.0}, 0.5, {}},
              {{Geometry::Plane, 0.5, 1.0}, 0.27, {}},  {{Geometry::Plane, 0.5, 0.5}, 0.15, {}},
              {{Geometry::Plane, 0.35, 0.5}, 0.09, {}}, {{Geometry::Plane, 0.35, 0.25}, 0.06, {}}};
    default:
      return {{{Geometry::Mesh, 1.0, 1.0}, 1.0, {}},   {{Geometry::Mesh, 0.71, 1.0}, 0.55, {}},
              {{Geometry::Mesh, 0.5, 1.0}, 0.32, {}},  {{Geometry::Plane, 0.71, 1.0}, 0.25, {}},
              {{Geometry::Plane, 0.5, 1.0}, 0.15, {}}, {{Geometry::Plane, 0.35, 1.0}, 0.08, {}}};
  }
}

/// Measured, or from the nearest rung that has been.
std::optional<double> Governor::cost_of(const Ladder& ladder, std::size_t rung) {
  if (ladder[rung].cost_ms) return ladder[rung].cost_ms;
  std::optional<double> cost;
  std::size_t nearest = ladder.size();
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    const std::size_t distance = i > rung ? i - rung : rung - i;
    if (!ladder[i].cost_ms || distance >= nearest) continue;
    nearest = distance;
    cost = *ladder[i].cost_ms * ladder[rung].work / ladder[i].work;
  }
  return cost;
}

bool Governor::fits(const Ladder& ladder, std::size_t rung, double share) const {
  const std::optional<double> cost = cost_of(ladder, rung);
  return !cost || *cost <= share * budget_ms_;
}

void Governor::smooth_budget(double budget_ms) {
  const bool first = budget_ms_ <= 0.0;
  const double risen = budget_ms_ + kBudgetRise * (budget_ms - budget_ms_);
  budget_ms_ = std::max(0.0, first ? budget_ms : std::min(budget_ms, risen));
}

Effort Governor::choose(const Wish& wish, double budget_ms) {
  smooth_budget(budget_ms);
  kind_ = kind_of(wish);
  auto& [ladder, rung, choices_at_rung] = states_[kind_];
  const std::size_t before = rung;
  while (rung + 1 < ladder.size() && !fits(ladder, rung, 1.0)) ++rung;
  const bool may_rise = rung == before && rung > 0 && choices_at_rung >= kChoicesBeforeRise;
  if (may_rise && fits(ladder, rung - 1, kRoomToRise)) --rung;
  for (std::size_t better = 0; better < rung; ++better) {
    if (ladder[better].cost_ms) *ladder[better].cost_ms *= kForget;
  }
  choices_at_rung = rung == before ? choices_at_rung + 1 : 0;
  Effort quality = ladder[rung].quality;
  if (quality.geometry == Geometry::Plane && wish.geometry == Geometry::Focal) {
    quality.geometry = Geometry::Focal;
  }
  return quality;
}

void Governor::measured(double ms) {
  State& state = states_[kind_];
  std::optional<double>& cost = state.ladder[state.rung].cost_ms;
  cost = cost ? *cost + (ms > *cost ? kRise : kFall) * (ms - *cost) : ms;
}

double Governor::expected_ms() const {
  const State& state = states_[kind_];
  return cost_of(state.ladder, state.rung).value_or(0.0);
}

}  // namespace lumibox::render
