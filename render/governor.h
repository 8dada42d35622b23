#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "render/proxy_geometry.h"
#include "render/view.h"

namespace lumibox::render {

/// How a view is drawn if there is not the time for all of it.
struct Effort {
  Geometry geometry = Geometry::Plane;
  double scale = 1.0;    ///< of the picture's width and height
  double k_share = 1.0;  ///< of the perspectives asked for

  bool operator==(const Effort&) const = default;
};

/// "mesh, 0.71 of the size, 20 views" of k = 40.
std::string description(const Effort& quality, int k);

/// Settings with the number of perspectives that a quality leaves.
Settings at_effort(Settings settings, const Effort& quality);

/// Chooses the best effort that the time allows, from what each has cost on this machine. A single
/// measurement changes nothing: what a quality costs is the median of the last few, without the
/// first picture after a change, which also pays for the change. It knows no clock: the same
/// measurements make the same choices.
class Governor {
 public:
  /// What one wants to see: the geometry and aperture at full quality.
  struct Wish {
    Geometry geometry = Geometry::Plane;
    Aperture aperture = Aperture::Small;
  };

  Governor();

  /// The quality to draw with, in `budget_ms` milliseconds if that can be done.
  Effort choose(const Wish& wish, double budget_ms);

  /// What drawing with the quality chosen last took.
  void measured(double ms);

  /// What the choice made last is thought to take, and the time that was allowed for it.
  double expected_ms() const;
  double budget_ms() const { return budget_ms_; }

 private:
  static constexpr int kPatience = 10;  ///< choices

  struct Rung {
    Effort quality;
    double work = 1.0;                             ///< relative to full quality, about
    std::optional<double> cost_ms = std::nullopt;  ///< measured when it was in use last
    int patience = kPatience;  ///< choices before it is tried from the one below
  };
  using Ladder = std::vector<Rung>;  ///< best first

  /// How one of the three kinds of pictures is drawn at present.
  struct State {
    Ladder ladder;
    std::size_t rung = 0;
    int choices = 0;               ///< since it came to this rung
    bool on_trial = false;         ///< it came from below, not long ago
    bool changed = true;           ///< the next picture pays for a change
    std::vector<double> measured;  ///< the last few pictures since then, ms

    void go_to(std::size_t to);
    bool knows_cost() const;
    std::optional<double> by_work(std::size_t of) const;
    double at_most(std::size_t of) const;
    double at_least(std::size_t of) const;
  };

  static Ladder make_ladder(std::size_t kind);
  static std::size_t kind_of(const Wish& wish);
  void follow_budget(double budget_ms);
  void fall(State& state) const;
  void rise(State& state) const;

  std::array<State, 3> states_;
  std::size_t kind_ = 0;         ///< that was chosen for last
  std::vector<double> budgets_;  ///< the last few, ms
  double budget_ms_ = 0.0;
};

}  // namespace lumibox::render
