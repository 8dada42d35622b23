#pragma once

#include <memory>

#include "geometry/pose.h"
#include "hal/sim/hand_path.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// How something in the scene moves away from where the scene file put it.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual geometry::Pose world_from_rest(double time_s) const = 0;
};

/// Sways and turns about a pivot, as somebody does who cannot sit still.
class Fidgeting : public Motion {
 public:
  explicit Fidgeting(const MovingSubjectSpec& spec)
      : world_from_pivot_(Eigen::Quaterniond::Identity(), spec.pivot), wobble_(spec.wobble) {}

  geometry::Pose world_from_rest(double time_s) const override {
    return world_from_pivot_ * wobble_.at(time_s) * world_from_pivot_.inverse();
  }

 private:
  geometry::Pose world_from_pivot_;
  Wobble wobble_;
};

/// Goes straight from one point to another, once.
class Passage : public Motion {
 public:
  explicit Passage(const OccluderSpec& spec) : spec_(spec) {}

  geometry::Pose world_from_rest(double time_s) const override {
    const double t = std::clamp((time_s - spec_.start_s) / spec_.duration_s, 0.0, 1.0);
    return {Eigen::Quaterniond::Identity(), t * (spec_.to - spec_.from)};
  }

 private:
  OccluderSpec spec_;
};

}  // namespace lumibox::hal::sim
