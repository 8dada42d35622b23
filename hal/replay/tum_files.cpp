#include "hal/replay/tum_files.h"

#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>

#include "config/error.h"
#include "config/loader.h"
#include "config/output_file.h"
#include "geometry/camera.h"
#include "geometry/position.h"
#include "hal/replay/text_file.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;
using config::InputError;

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

/// A time whose nanoseconds fit a 64-bit integer.
double read_time(const TextLine& line, std::size_t column) {
  constexpr double kMaxSeconds = 9e9;
  const double seconds = line.number(column);
  if (std::abs(seconds) > kMaxSeconds) {
    throw line.error("time of " + line.quoted(column) + " seconds; expected less than 9e9");
  }
  return seconds;
}

void check_after(double seconds, std::optional<double> previous_seconds, const TextLine& line) {
  if (previous_seconds && nanoseconds(seconds) <= nanoseconds(*previous_seconds)) {
    throw line.error("time " + line.quoted(0) +
                     " is not after the one before it; expected increasing times");
  }
}

Eigen::Vector3d read_position(const TextLine& line, std::size_t first_column) {
  const Eigen::Vector3d position(line.number(first_column), line.number(first_column + 1),
                                 line.number(first_column + 2));
  if (const auto fault = geometry::fault_of_position(position)) throw line.error(*fault);
  return position;
}

StampedPose read_pose(const TextLine& line) {
  line.expect_count(8, 8, "t tx ty tz qx qy qz qw");
  StampedPose pose;
  pose.timestamp_s = read_time(line, 0);
  pose.world_from_camera.translation = read_position(line, 1);
  const Eigen::Quaterniond rotation(line.number(7), line.number(4), line.number(5), line.number(6));
  // Rounded to a few digits in files; anything farther from unit length is not a quaternion.
  constexpr double kTolerance = 0.05;
  if (!(std::abs(rotation.norm() - 1.0) <= kTolerance)) {
    throw line.error("quaternion of length " + std::to_string(rotation.norm()) + "; expected 1");
  }
  pose.world_from_camera.rotation = rotation.normalized();
  return pose;
}

/// What calibrate refuses too. Nothing can be tracked where there is no telling where a pixel
/// looks, and what would be said then is that the pictures are bad.
std::optional<std::string> fault_of_lens(const config::CameraProfile& profile) {
  const auto corner = geometry::Camera(profile).corner_beyond_fold();
  if (!corner) return std::nullopt;
  std::ostringstream message;
  message << "the distortion turns back before pixel " << corner->x() << ", " << corner->y()
          << "; expected a lens that shows the whole picture of " << profile.width << "x"
          << profile.height;
  return message.str();
}

enum class Times { Any, Increasing };

std::vector<StampedPose> read_poses(const fs::path& file, Times times) {
  const TextFile text(file);
  std::vector<StampedPose> poses;
  for (const TextLine& line : text.lines()) {
    const StampedPose pose = read_pose(line);
    if (times == Times::Increasing && !poses.empty()) {
      check_after(pose.timestamp_s, poses.back().timestamp_s, line);
    }
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace

std::vector<ImageLine> read_image_list(const fs::path& file) {
  const TextFile text(file);
  std::vector<ImageLine> images;
  std::optional<double> previous;
  for (const TextLine& line : text.lines()) {
    const double seconds = read_time(line, 0);
    check_after(seconds, previous, line);
    previous = seconds;
    images.push_back({line.line(), nanoseconds(seconds), line.rest_after_first()});
  }
  if (images.empty()) {
    throw InputError(file, "names no images; expected lines `timestamp file`");
  }
  return images;
}

config::CameraProfile read_calibration(const fs::path& file) {
  if (file.extension() == ".toml") {
    const config::CameraProfile profile = config::load_camera_profile(file);
    if (const auto fault = fault_of_lens(profile)) throw InputError(file, *fault);
    return profile;
  }
  const TextFile text(file);
  const std::string expected = "fx fy cx cy k1 k2 p1 p2 width height fps [k3 [readout_s]]";
  if (text.lines().size() != 1) {
    throw InputError(
        file, std::to_string(text.lines().size()) + " lines of numbers; expected one: " + expected);
  }
  const TextLine& line = text.lines().front();
  line.expect_count(11, 13, expected);
  config::CameraProfile profile;
  profile.fx = line.number(0);
  profile.fy = line.number(1);
  profile.cx = line.number(2);
  profile.cy = line.number(3);
  profile.k1 = line.number(4);
  profile.k2 = line.number(5);
  profile.p1 = line.number(6);
  profile.p2 = line.number(7);
  profile.width = line.integer(8);
  profile.height = line.integer(9);
  profile.fps = line.number(10);
  profile.k3 = line.count() > 11 ? line.number(11) : 0.0;
  profile.readout_s = line.count() > 12 ? line.number(12) : 0.0;
  if (const auto fault = config::fault_of(profile)) {
    throw line.error(*fault);
  }
  if (const auto fault = fault_of_lens(profile)) throw line.error(*fault);
  return profile;
}

std::vector<StampedPose> read_tum_trajectory(const fs::path& file) {
  return read_poses(file, Times::Any);
}

std::vector<StampedPose> read_ground_truth(const fs::path& file) {
  return read_poses(file, Times::Increasing);
}

Sequence::Subject read_subject(const fs::path& file) {
  const TextFile text(file);
  if (text.lines().size() != 1) {
    throw InputError(file, "expected one line: x y z radius");
  }
  const TextLine& line = text.lines().front();
  line.expect_count(4, 4, "x y z radius");
  const double radius = line.number(3);
  if (!(radius > 0.0 && radius <= geometry::kLargestCoordinate)) {
    throw line.error("radius of " + line.quoted(3) + "; expected more than 0, up to 1e9");
  }
  return {read_position(line, 0), radius};
}

void write_tum_trajectory(const fs::path& file, const std::vector<StampedPose>& trajectory) {
  std::ostringstream out;
  out << "# timestamp tx ty tz qx qy qz qw (world from camera)\n" << std::fixed;
  out << std::setprecision(9);
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.world_from_camera.translation;
    Eigen::Quaterniond q = pose.world_from_camera.rotation;
    if (q.w() < 0.0) {
      q.coeffs() = -q.coeffs();
    }
    out << pose.timestamp_s << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' '
        << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
  }
  config::write_text(file, out.str());
}

}  // namespace lumibox::hal
