#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "config/camera_profile.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "hal/image.h"

namespace lumibox::hal {

namespace sim {
struct SceneSpec;
}

/// A scene file (TOML) made ready: geometry, textures, lights, the hand's path, effects.
/// docs/simulation.md describes the format.
class Scene {
 public:
  struct Subject {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 1.0;
  };

  ~Scene();

  const config::CameraProfile& profile() const;
  std::int64_t frame_count() const;
  std::int64_t timestamp_ns(std::int64_t frame) const;

  /// Where the hand holds the camera at a time (from 0), tremor included.
  geometry::Pose world_from_camera(double time_s) const;

  Subject subject() const;

  /// The scene at a time as an ideal camera sees it: no lens, sensor or shutter effects. What
  /// rendered light fields are compared with.
  Image render_ideal(const geometry::Camera& camera, const geometry::Pose& world_from_camera,
                     double time_s) const;

  /// Where an ideal camera sees the subject at a time: 255 in pixels whose nearest surface lies
  /// within the subject's sphere, 0 elsewhere. One channel.
  Image subject_mask(const geometry::Camera& camera, const geometry::Pose& world_from_camera,
                     double time_s) const;

  class Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Reads a scene file; throws config::InputError with file, line, key and what is allowed.
std::shared_ptr<const Scene> load_scene(const std::filesystem::path& file);

/// Makes a scene ready that did not come from a file, e.g. sim::random_scene().
std::shared_ptr<const Scene> make_scene(const sim::SceneSpec& spec);

/// Renders every frame of the scene with its effects into a sequence folder (rgb.txt, rgb/ as PNG,
/// calib.txt, groundtruth.txt, subject.txt). `folder` must be empty or absent.
/// `progress(done, total)` may be empty.
void write_sequence(const Scene& scene, const std::filesystem::path& folder,
                    const std::function<void(std::int64_t, std::int64_t)>& progress);

}  // namespace lumibox::hal
