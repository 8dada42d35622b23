#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/moment.h"
#include "app/recorder.h"
#include "config/config.h"
#include "geometry/camera.h"

namespace lumibox::app {

/// Where in a recording the subject is.
struct SubjectPixel {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  std::int64_t frame = 0;  ///< index of the frame the pixel is in
};

/// Captures from a recording as the box would in the hand, without anybody to press a button: the
/// sphere goes where the ray of the reticle (the middle of the picture, or of a given pixel) meets
/// the depth of the tracked points around it; from then on the gate decides.
class AutoCapture {
 public:
  /// Without `subject` the sphere is placed in the first frame that is tracked well. A recorder
  /// that goes on with a capture has its sphere.
  AutoCapture(Recorder& recorder, const geometry::Camera& camera, const config::Capture& options,
              std::filesystem::path folder, const std::optional<SubjectPixel>& subject);

  void see(const Moment& moment);

  /// False as long as the sphere could not be placed.
  bool placed() const { return placed_; }

 private:
  void place(const Moment& moment);

  Recorder& recorder_;
  geometry::Camera camera_;
  config::Capture options_;
  std::filesystem::path folder_;
  SubjectPixel subject_;
  bool subject_given_;
  bool placed_ = false;
};

}  // namespace lumibox::app
