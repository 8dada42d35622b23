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

/// Chooses the best effort that the time allows, from what each has cost on this machine. It knows
/// no clock: the same measurements make the same choices.
class Governor {
 public:
  /// What one wants to see: the geometry and aperture at full quality.
  struct Wish {
    Geometry geometry = Geometry::Plane;
    Aperture aperture = Aperture::Small;
  };

  /// The quality to draw with, in `budget_ms` milliseconds if that can be done.
  Effort choose(const Wish& wish, double budget_ms);

  /// What drawing with the quality chosen last took.
  void measured(double ms);

  /// What the choice made last is thought to take, and the time that was allowed for it.
  double expected_ms() const;
  double budget_ms() const { return budget_ms_; }

 private:
  struct Rung {
    Effort quality;
    double work = 1.0;              ///< relative to full quality, until it has been measured
    std::optional<double> cost_ms;  ///< measured
  };
  using Ladder = std::vector<Rung>;  ///< best first

  static Ladder make_ladder(std::size_t kind);
  static std::size_t kind_of(const Wish& wish);
  static std::optional<double> cost_of(const Ladder& ladder, std::size_t rung);
  void smooth_budget(double budget_ms);
  bool fits(const Ladder& ladder, std::size_t rung, double share) const;

  struct State {
    Ladder ladder;
    std::size_t rung = 0;
    int choices_at_rung = 0;
  };
  std::array<State, 3> states_ = {State{make_ladder(0)}, State{make_ladder(1)},
                                  State{make_ladder(2)}};
  std::size_t kind_ = 0;  ///< that was chosen for last
  double budget_ms_ = 0.0;
};

}  // namespace lumibox::render
