#include "hal/sim/hand_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/rotation.h"
#include "hal/sim/random.h"

namespace lumibox::hal::sim {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Position and target of the walk before smoothing.
using Station = Eigen::Vector<double, 6>;

Station station(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  Station s;
  s << position, target;
  return s;
}

/// The orbit as a serpentine on a sphere, walked at constant speed; `progress` in [0, 1].
Station orbit_station(const OrbitSpec& orbit, const Eigen::Vector3d& target, double progress) {
  const double climb =
      orbit.rows > 1 ? (orbit.elevation_deg[1] - orbit.elevation_deg[0]) / (orbit.rows - 1) : 0.0;
  const auto elevation = [&](int row) { return orbit.elevation_deg[0] + climb * row; };
  const double sweep = orbit.azimuth_deg[1] - orbit.azimuth_deg[0];
  const auto sweep_length = [&](int row) {
    return std::abs(sweep) * std::cos(elevation(row) * kRadians);
  };
  double total = std::abs(climb) * (orbit.rows - 1);
  for (int row = 0; row < orbit.rows; ++row) total += sweep_length(row);

  double left = progress * total;
  int row = 0;
  double along = 0.0;    // of this row's sweep, 0..1
  double climbed = 0.0;  // from this row to the next, degrees
  while (true) {
    const double length = sweep_length(row);
    along = length > 0.0 ? std::min(left / length, 1.0) : 1.0;
    left -= length;
    if (left <= 0.0 || row + 1 == orbit.rows) break;
    climbed = std::min(left, std::abs(climb));
    left -= climbed;
    if (left <= 0.0) break;
    climbed = 0.0;
    ++row;
  }
  const bool forward = row % 2 == 0;
  const double azimuth =
      (forward ? orbit.azimuth_deg[0] + along * sweep : orbit.azimuth_deg[1] - along * sweep) *
      kRadians;
  const double height = (elevation(row) + std::copysign(climbed, climb)) * kRadians;
  // One slow breath of the radius per sweep and a half: never in step with the rows.
  const double breath = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * progress * orbit.rows / 1.5);
  const double radius = std::lerp(orbit.radius_m[0], orbit.radius_m[1], breath);
  const Eigen::Vector3d outwards(std::cos(height) * std::sin(azimuth),
                                 -std::cos(height) * std::cos(azimuth), std::sin(height));
  return station(target + radius * outwards, target);
}

/// Catmull-Rom spline through the keys (Catmull and Rom, 1974), tangents by central differences.
Station key_station(const std::vector<KeyPose>& keys, double time_s) {
  const auto at = [&](std::size_t i) { return station(keys[i].position, keys[i].target); };
  if (time_s <= keys.front().time_s) return at(0);
  if (time_s >= keys.back().time_s) return at(keys.size() - 1);
  std::size_t i = 0;
  while (keys[i + 1].time_s <= time_s) ++i;
  const auto tangent = [&](std::size_t k) -> Station {
    const std::size_t before = k > 0 ? k - 1 : k;
    const std::size_t after = std::min(k + 1, keys.size() - 1);
    return (at(after) - at(before)) / (keys[after].time_s - keys[before].time_s);
  };
  const double span = keys[i + 1].time_s - keys[i].time_s;
  const double t = (time_s - keys[i].time_s) / span;
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * at(i) + (t3 - 2 * t2 + t) * span * tangent(i) +
         (3 * t2 - 2 * t3) * at(i + 1) + (t3 - t2) * span * tangent(i + 1);
}

Station walk_station(const PathSpec& spec, double duration_s, double time_s) {
  const double walk_s = std::max(duration_s - spec.lead_in_s, 1e-6);
  const double into_walk = std::clamp(time_s - spec.lead_in_s, 0.0, walk_s);
  Station s = spec.orbit ? orbit_station(*spec.orbit, spec.target, into_walk / walk_s)
                         : key_station(spec.keys, into_walk);
  if (spec.lead_in_s > 0.0 && time_s < spec.lead_in_s) {
    // The walk begins with a step sideways, which gives a monocular tracker its baseline.
    const geometry::Pose pose = look_at(s.head<3>(), s.tail<3>());
    const double left = spec.lead_in_m * (1.0 - std::max(time_s, 0.0) / spec.lead_in_s);
    s.head<3>() -= left * pose.matrix3().col(0);
  }
  return s;
}

}  // namespace

Wobble::Wobble(const WobbleSpec& spec) {
  constexpr int kWaves = 8;
  Random random(spec.seed);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const double rms = axis < 3 ? spec.position_mm * 1e-3 : spec.rotation_deg * kRadians;
    double power = 0.0;
    for (int i = 0; i < kWaves; ++i) {
      const double hz = spec.min_hz * std::pow(spec.max_hz / spec.min_hz, random.uniform());
      // Slow movements are large, fast ones small.
      const double amplitude = 1.0 / hz;
      power += 0.5 * amplitude * amplitude;
      waves_[axis].push_back(
          {amplitude, 2.0 * std::numbers::pi * hz, random.uniform(0.0, 2.0 * std::numbers::pi)});
    }
    for (Wave& wave : waves_[axis]) wave.amplitude *= rms / std::sqrt(power);
  }
}

geometry::Pose Wobble::at(double time_s, double strength) const {
  Eigen::Vector<double, 6> value = Eigen::Vector<double, 6>::Zero();
  for (std::size_t axis = 0; axis < 6; ++axis) {
    for (const Wave& wave : waves_[axis]) {
      value[static_cast<Eigen::Index>(axis)] +=
          wave.amplitude * std::sin(wave.angular_frequency * time_s + wave.phase);
    }
  }
  value *= strength;
  return {geometry::exp_so3(value.tail<3>()), value.head<3>()};
}

HandPath::HandPath(const PathSpec& spec, double duration_s)
    : tremor_(spec.tremor), shake_(spec.shake), shaking_(shake_ ? shake_->wobble : WobbleSpec{}) {
  const int count = static_cast<int>(std::ceil(duration_s / knot_spacing_s_)) + 4;
  for (int i = 0; i < count; ++i) {
    // One knot before time 0, as the spline below wants.
    knots_.push_back(walk_station(spec, duration_s, (i - 1) * knot_spacing_s_));
  }
}

geometry::Pose HandPath::world_from_camera(double time_s) const {
  // Uniform cubic B-spline: smooths the corners of the walk over a second.
  const double at =
      std::clamp(time_s / knot_spacing_s_, 0.0, static_cast<double>(knots_.size() - 4));
  const auto i = std::min(static_cast<std::size_t>(at), knots_.size() - 4);
  const double t = at - static_cast<double>(i);
  const double t2 = t * t;
  const double t3 = t2 * t;
  const Eigen::Vector<double, 6> s =
      ((1 - 3 * t + 3 * t2 - t3) * knots_[i] + (4 - 6 * t2 + 3 * t3) * knots_[i + 1] +
       (1 + 3 * t + 3 * t2 - 3 * t3) * knots_[i + 2] + t3 * knots_[i + 3]) /
      6.0;
  const geometry::Pose steady = look_at(s.head<3>(), s.tail<3>()) * tremor_.at(time_s);
  if (!shake_) return steady;
  const double through = std::clamp((time_s - shake_->start_s) / shake_->duration_s, 0.0, 1.0);
  return steady * shaking_.at(time_s, std::pow(std::sin(std::numbers::pi * through), 2));
}

geometry::Pose look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  Eigen::Vector3d forward = target - position;
  // A spline may touch what its keys avoid: no direction, or straight up or down.
  if (forward.norm() < 1e-9) forward = Eigen::Vector3d::UnitY();
  forward.normalize();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-9) right = Eigen::Vector3d::UnitX();
  right.normalize();
  Eigen::Matrix3d rotation;
  rotation << right, forward.cross(right), forward;
  return {rotation, position};
}

}  // namespace lumibox::hal::sim
