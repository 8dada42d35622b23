#include "hal/sim/random_walk.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "geometry/rotation.h"

namespace lumibox::hal::sim {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kKeySpacing_s = 0.25;

/// A curve on a sphere around the target whose radius and elevation sway; `progress` from 0 to 1.
struct Course {
  double azimuth_deg = 0.0;  // where it begins
  double extent_deg = 0.0;   // of one sweep; what turns back at its end sweeps again
  double sweeps = 1.0;
  double elevation_deg = 0.0;  // where it begins
  double climb_deg = 0.0;      // from the beginning to the end
  double sway_deg = 0.0;       // of the elevation, this much up and down
  double radius_m = 0.0;
  double breath_m = 0.0;  // of the radius, this much in and out
  int waves = 1;          // of sway and breath; whole ones, so that an orbit ends where it began
  double phase = 0.0;

  Eigen::Vector3d outwards(double progress) const {
    const double sweep = progress * sweeps;
    const double turned = std::fmod(sweep, 2.0);
    const double along = sweeps > 1.0 && turned > 1.0 ? 2.0 - turned : turned;
    const double azimuth = (azimuth_deg + along * extent_deg) * kRadians;
    // A sway belongs to a place, so that whoever comes back to the place is back altogether.
    const double sway = phase + waves * (azimuth - azimuth_deg * kRadians);
    const double elevation =
        (elevation_deg + progress * climb_deg + sway_deg * std::sin(sway)) * kRadians;
    const double radius = radius_m + breath_m * std::sin(sway + 1.0);
    return radius * Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth),
                                    -std::cos(elevation) * std::cos(azimuth), std::sin(elevation));
  }
};

Course random_course(Walk walk, const WalkRoom& room, Random& random) {
  const auto elevation = [&] {
    return random.uniform(room.elevation_deg[0], room.elevation_deg[1]);
  };
  Course course;
  course.azimuth_deg = random.uniform(-180.0, 180.0);
  course.breath_m = random.uniform(0.0, 0.12) * room.radius_m[0];
  course.radius_m =
      random.uniform(room.radius_m[0] + course.breath_m, room.radius_m[1] - course.breath_m);
  course.waves = 1 + random.below(2);
  course.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  course.elevation_deg = elevation();
  if (walk == Walk::Orbit) {
    course.extent_deg = 360.0 + random.uniform(3.0, 20.0);
    const double margin = std::min(course.elevation_deg - room.elevation_deg[0],
                                   room.elevation_deg[1] - course.elevation_deg);
    course.sway_deg = random.uniform(0.0, std::min(margin, 8.0));
  } else {
    course.extent_deg = random.uniform(room.extent_deg[0], room.extent_deg[1]);
    // No more sweeps than a hand makes in about 15 seconds.
    const int most = std::max(1, static_cast<int>(330.0 / course.extent_deg));
    course.sweeps = 1.0 + random.below(std::min(most, room.most_sweeps));
    course.climb_deg = elevation() - course.elevation_deg;
  }
  if (random.uniform() < 0.5) course.extent_deg = -course.extent_deg;
  if (room.from_the_front) course.azimuth_deg = -0.5 * course.extent_deg;
  return course;
}

/// Where along its course a hand is: at rest first, then at a speed that varies, in the middle
/// perhaps at rest again.
struct Pacing {
  double rest_s = 0.0;        // before it begins to move
  double walk_s = 0.0;        // for the course, without rests
  double stop_s = 0.0;        // in the middle of it
  double unsteadiness = 0.0;  // share by which the speed varies
  int waves = 2;

  double duration_s() const { return rest_s + walk_s + stop_s; }
  double stop_begins_s() const { return rest_s + 0.5 * walk_s; }

  double progress(double time_s) const {
    double walked_s = time_s - rest_s;
    if (walked_s > 0.5 * walk_s) walked_s = std::max(0.5 * walk_s, walked_s - stop_s);
    const double u = std::clamp(walked_s / walk_s, 0.0, 1.0);
    const double turn = 2.0 * std::numbers::pi * waves;
    return u - unsteadiness * std::sin(turn * u) / turn;
  }
};

/// Turn of the sight away and back, as a share of the whole, over a stop of so many seconds.
double turned_away(double into_stop_s, double stop_s) {
  // Rest at either end: what smooths the path reaches so far, and the turn is to be without
  // translation.
  constexpr double kRest_s = 0.75;
  const double u = std::clamp((into_stop_s - kRest_s) / (stop_s - 2.0 * kRest_s), 0.0, 1.0);
  return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * u);
}

ShakeSpec random_shake(double middle_s, double scale_m, Random& random) {
  ShakeSpec shake;
  shake.duration_s = 0.5;
  shake.start_s = middle_s - 0.25;
  shake.wobble = {.position_mm = 1e3 * scale_m * random.uniform(0.01, 0.03),
                  .rotation_deg = random.uniform(3.0, 6.0),
                  .min_hz = 3.0,
                  .max_hz = 6.0,
                  .seed = random.bits() >> 40};
  return shake;
}

}  // namespace

RandomWalk random_walk(Walk walk, const WalkRoom& room, Random& random) {
  const Course course = random_course(walk, room, random);
  const double speed_deg = random.uniform(20.0, 30.0);
  const double arc_deg = std::abs(course.extent_deg) * course.sweeps;
  Pacing pacing;
  pacing.walk_s = std::clamp(arc_deg / speed_deg, 9.0, 18.0);
  pacing.unsteadiness = random.uniform(0.0, 0.5);
  pacing.waves = 2 + random.below(3);

  RandomWalk result;
  PathSpec& path = result.path;
  if (random.uniform() < 0.5) {
    path.lead_in_s = random.uniform(0.8, 1.8);
    path.lead_in_m = course.radius_m * random.uniform(0.12, 0.25);
  } else {
    pacing.rest_s = random.uniform(0.1, 0.7);
  }
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  if (walk == Walk::Turn) {
    pacing.stop_s = random.uniform(3.5, 4.5);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    turn = side * random.uniform(36.0, 44.0) * kRadians * Eigen::Vector3d::UnitZ();
  }
  const int keys = static_cast<int>(std::ceil(pacing.duration_s() / kKeySpacing_s)) + 1;
  for (int i = 0; i < keys; ++i) {
    const double time_s = i * kKeySpacing_s;
    const Eigen::Vector3d out = course.outwards(pacing.progress(time_s));
    Eigen::Vector3d sight = -out;
    if (walk == Walk::Turn) {
      const double share = turned_away(time_s - pacing.stop_begins_s(), pacing.stop_s);
      sight = geometry::exp_so3(share * turn) * sight;
    }
    path.keys.push_back({time_s, room.target + out, room.target + out + sight});
  }
  result.duration_s = path.lead_in_s + pacing.duration_s();
  const double scale = course.radius_m / 0.6;
  path.tremor = {.position_mm = std::min(scale * random.uniform(0.5, 2.0), 8.0),
                 .rotation_deg = random.uniform(0.1, 0.4),
                 .seed = random.bits() >> 40};
  if (walk == Walk::Shake) {
    const double middle_s = path.lead_in_s + pacing.rest_s + 0.5 * pacing.walk_s;
    path.shake = random_shake(middle_s, course.radius_m, random);
  }
  return result;
}

}  // namespace lumibox::hal::sim
