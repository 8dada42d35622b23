#pragma once

#include <cstdint>
#include <optional>

#include "geometry/camera.h"
#include "geometry/rolling_shutter.h"
#include "tracking/rotation_prior.h"

namespace lumibox::tracking {

/// How the camera is expected to have moved since the last frame: constant velocity, unless the
/// picture says that it turned otherwise.
class MotionModel {
 public:
  explicit MotionModel(const geometry::Camera& camera) : camera_(camera) {}

  /// A new frame; the one before becomes the last.
  void next_frame(const Pyramid& picture, std::int64_t timestamp_ns);

  const SmallImage& picture() const { return current_; }
  std::int64_t timestamp_ns() const { return timestamp_ns_; }  ///< of the new frame
  double interval_s() const { return interval_s_; }            ///< since the last

  /// Pose of the new frame, from that of the last.
  geometry::FramePose predict(const geometry::Pose& last_from_world) const;

  /// The same if the camera went on as it did, whatever the picture shows.
  geometry::Pose expect(const geometry::Pose& last_from_world) const;

  /// The motion during the new frame's readout, now that its pose is known: that since the last
  /// frame, and as much change as there was before, for half an interval lies between the two.
  geometry::Vector6d readout_twist(const geometry::Pose& last_from_world,
                                   const geometry::Pose& current_from_world) const;

  /// Remembers the motion found; without one nothing is known for the next frame.
  void moved(const geometry::Pose& last_from_world, const geometry::Pose& current_from_world);
  void interrupted() { velocity_.reset(); }

  /// Twist per second from the left, to the frame located last.
  const std::optional<geometry::Vector6d>& velocity() const { return velocity_; }

 private:
  geometry::Pose current_from_last() const;

  geometry::Camera camera_;
  SmallImage last_;
  SmallImage current_;
  std::int64_t timestamp_ns_ = 0;
  double interval_s_ = 0.0;  ///< since the last frame
  std::optional<geometry::Vector6d> velocity_;
};

}  // namespace lumibox::tracking
