#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/aperture.h"
#include "app/modes/mode.h"
#include "app/placement.h"

namespace lumibox::app {

/// Thesis 2.2: the person says what the subject is, by sliding a sphere along the ray of the
/// reticle, or by focusing the augmented aperture on it.
class SubjectMode : public Mode {
 public:
  SubjectMode(Session& session, const geometry::Camera& camera);

  void enter(const Moment& moment) override;
  ModeId press(const Gesture& gesture, const Moment& moment) override;
  ModeId update(const Moment& moment) override;
  Picture draw(const Moment& moment) const override;

 private:
  /// Points the ray where the box points.
  void aim(const Moment& moment);

  /// Where the sphere would be now; none as long as no depth is known.
  std::optional<lightfield::Sphere> sphere() const;
  /// Moves the sphere, or where it would be placed, along the ray.
  void slide(int steps);
  void place();
  std::string title() const;
  void toggle_aperture();
  ModeId take_back(const Moment& moment);
  ModeId confirm(const Moment& moment);

  Session& session_;
  geometry::Camera camera_;
  std::optional<Ray> ray_;              ///< the reticle's, in world; stands still once placed
  std::optional<double> first_depth_;   ///< of the tracked points around the ray
  int depth_steps_ = 0;                 ///< slid by the person, before placing it or after
  bool placed_ = false;                 ///< the ray stands still in the world
  std::unique_ptr<Aperture> aperture_;  ///< while the augmented aperture is on
};

}  // namespace lumibox::app
