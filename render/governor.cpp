#include "render/governor.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/robust.h"

namespace lumibox::render {
namespace {

// One picture that other work delayed says nothing, three of the last five do; of the first two
// after a change the quicker counts. So what is too slow is left after three pictures.
constexpr std::size_t kMeasured = 5;
constexpr std::size_t kLeastMeasured = 2;
// The time left may differ from one tick to the next, as with a camera slower than the loop: the
// shorter ones count, but not a single one.
constexpr std::size_t kBudgets = 12;
constexpr double kBudgetShare = 0.3;
// A better quality is taken up only if it needs clearly less than there is, and not at once: what
// changes back and forth is worse than either. From the last rung to the first it takes 50 choices.
constexpr double kRoomToRise = 0.8;
// One that is left again within so many choices waits three times as long for the next trial, at
// the most nine seconds.
constexpr int kTrial = 150;
constexpr int kMostPatience = 270;
// What was too slow is thought a little faster with each choice, until it is tried again: other
// work that made it slow may be over. Half the cost in 15 s at 30 choices a second.
constexpr double kForget = 0.99846;

void push(std::vector<double>& last, double value, std::size_t most) {
  if (last.size() == most) last.erase(last.begin());
  last.push_back(value);
}

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
  if (wish.aperture == Aperture::Wide) return 1;
  return wish.geometry == Geometry::Mesh ? 2 : 0;
}

Governor::Ladder Governor::make_ladder(std::size_t kind) {
  // A small picture enlarged is liked better than one with jumps or ghosts; the shape at half the
  // size is likelier than planes at the full one (docs/benchmarks.md).
  switch (kind) {
    case 0:
      return {{{Geometry::Plane, 1.0, 1.0}, 1.0},
              {{Geometry::Plane, 0.71, 1.0}, 0.5},
              {{Geometry::Plane, 0.5, 1.0}, 0.27},
              {{Geometry::Plane, 0.35, 1.0}, 0.15}};
    case 1:
      return {{{Geometry::Plane, 1.0, 1.0}, 1.0},   {{Geometry::Plane, 0.71, 1.0}, 0.5},
              {{Geometry::Plane, 0.5, 1.0}, 0.27},  {{Geometry::Plane, 0.5, 0.5}, 0.15},
              {{Geometry::Plane, 0.35, 0.5}, 0.09}, {{Geometry::Plane, 0.35, 0.25}, 0.06}};
    default:
      return {{{Geometry::Mesh, 1.0, 1.0}, 1.0},   {{Geometry::Mesh, 0.71, 1.0}, 0.55},
              {{Geometry::Mesh, 0.5, 1.0}, 0.32},  {{Geometry::Plane, 0.71, 1.0}, 0.25},
              {{Geometry::Plane, 0.5, 1.0}, 0.15}, {{Geometry::Plane, 0.35, 1.0}, 0.08}};
  }
}

Governor::Governor() {
  for (std::size_t kind = 0; kind < states_.size(); ++kind) {
    states_[kind].ladder = make_ladder(kind);
  }
}

void Governor::State::go_to(std::size_t to) {
  rung = to;
  choices = 0;
  changed = true;
  measured.clear();
}

bool Governor::State::knows_cost() const {
  return measured.size() >= kLeastMeasured;
}

/// What a rung should take, given what the present one takes.
std::optional<double> Governor::State::by_work(std::size_t of) const {
  if (!ladder[rung].cost_ms) return std::nullopt;
  return *ladder[rung].cost_ms * ladder[of].work / ladder[rung].work;
}

/// The larger of that and what was measured there; and the smaller. Without either, nothing.
double Governor::State::at_most(std::size_t of) const {
  return std::max(by_work(of).value_or(0.0), ladder[of].cost_ms.value_or(0.0));
}

double Governor::State::at_least(std::size_t of) const {
  const double by_work_ms = by_work(of).value_or(0.0);
  return std::min(by_work_ms, ladder[of].cost_ms.value_or(by_work_ms));
}

void Governor::follow_budget(double budget_ms) {
  push(budgets_, std::max(budget_ms, 0.0), kBudgets);
  budget_ms_ = geometry::quantile(budgets_, kBudgetShare);
}

/// To the first rung that is thought to fit, or to the last.
void Governor::fall(State& state) const {
  const std::size_t last = state.ladder.size() - 1;
  std::size_t to = state.rung;
  while (to < last && state.at_most(to) > budget_ms_) ++to;
  if (to == state.rung) return;
  int& patience = state.ladder[state.rung].patience;
  if (std::exchange(state.on_trial, false)) patience = std::min(3 * patience, kMostPatience);
  state.go_to(to);
}

void Governor::rise(State& state) const {
  const std::size_t better = state.rung - 1;
  if (state.choices < state.ladder[better].patience) return;
  if (state.at_least(better) > kRoomToRise * budget_ms_) return;
  state.go_to(better);
  state.on_trial = true;
}

Effort Governor::choose(const Wish& wish, double budget_ms) {
  follow_budget(budget_ms);
  const std::size_t before = std::exchange(kind_, kind_of(wish));
  State& state = states_[kind_];
  if (kind_ != before) state.go_to(state.rung);
  ++state.choices;
  if (state.choices > kTrial && std::exchange(state.on_trial, false)) {
    state.ladder[state.rung].patience = kPatience;
  }
  if (state.knows_cost()) {
    const std::size_t rung = state.rung;
    fall(state);
    if (state.rung == rung && rung > 0) rise(state);
  }
  for (std::size_t better = 0; better < state.rung; ++better) {
    if (state.ladder[better].cost_ms) *state.ladder[better].cost_ms *= kForget;
  }
  Effort quality = state.ladder[state.rung].quality;
  if (quality.geometry == Geometry::Plane && wish.geometry == Geometry::Focal) {
    quality.geometry = Geometry::Focal;
  }
  return quality;
}

void Governor::measured(double ms) {
  State& state = states_[kind_];
  if (std::exchange(state.changed, false)) return;
  push(state.measured, ms, kMeasured);
  if (state.knows_cost())
    state.ladder[state.rung].cost_ms = geometry::quantile(state.measured, 0.5);
}

double Governor::expected_ms() const {
  const State& state = states_[kind_];
  return state.ladder[state.rung].cost_ms.value_or(0.0);
}

}  // namespace lumibox::render
