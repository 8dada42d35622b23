#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/camera_profile.h"
#include "geometry/pose.h"

namespace lumibox::hal {

struct StampedPose {
  double timestamp_s = 0.0;
  geometry::Pose world_from_camera;
};

/// A recording in the layout of the TUM RGB-D benchmark (rgb.txt, images or rgb.mp4, calib.txt,
/// optional groundtruth.txt and subject.txt), a bare video file, or a folder of images.
struct Sequence {
  struct Entry {
    std::int64_t timestamp_ns = 0;
    std::filesystem::path image;  ///< absolute or relative to the working folder; empty in a video
  };
  struct Subject {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< in the ground truth's world
    double radius = 1.0;
  };

  std::filesystem::path path;  ///< folder or video file, as given
  std::optional<std::filesystem::path> video;
  std::vector<Entry> entries;
  config::CameraProfile profile;
  bool profile_assumed = false;           ///< no calibration was given: a field of view was assumed
  std::vector<StampedPose> ground_truth;  ///< world from camera, by time; may be empty
  std::optional<Subject> subject;
};

/// Reads and checks a sequence: every file named exists and lies inside the folder, times increase,
/// numbers are finite, the intrinsics are plausible, the first image has the size calib.txt says.
/// `calibration` overrides the sequence's own. Without either a bare video (60 degrees) or a folder
/// of images without rgb.txt (45 degrees, 30 frames per second, in order of name) gets an assumed
/// horizontal field of view. Throws config::InputError with file and line.
Sequence open_sequence(const std::filesystem::path& path,
                       const std::optional<std::filesystem::path>& calibration = std::nullopt);

/// A calib.txt: `fx fy cx cy k1 k2 p1 p2 width height fps [k3 [readout_s]]`; or a camera profile
/// (config::load_camera_profile) if the name ends in .toml. Errors as above.
config::CameraProfile read_calibration(const std::filesystem::path& file);

/// Lines `t tx ty tz qx qy qz qw`, world from camera. Quaternions are normalised. Errors as above.
std::vector<StampedPose> read_tum_trajectory(const std::filesystem::path& file);

/// Writes the same, quaternions with w >= 0, times with nine digits.
void write_tum_trajectory(const std::filesystem::path& file,
                          const std::vector<StampedPose>& trajectory);

}  // namespace lumibox::hal
