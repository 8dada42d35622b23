#include "app/sight.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace lumibox::app {

MapNow map_of(const tracking::Tracker& tracker) {
  const auto points = [&tracker] {
    std::vector<Eigen::Vector3d> positions;
    for (const tracking::MapPoint& point : tracker.points()) {
      positions.push_back(point.position);
    }
    return positions;
  };
  return {tracker.map_revision(),
          [&tracker](tracking::KeyframeId id) { return tracker.world_from_keyframe(id); }, points,
          [&tracker] { return tracker.map(); }};
}

Sight::Sight(hal::Camera& camera, const hal::Clock& clock, tracking::Tracker& tracker)
    : camera_(camera), clock_(clock), tracker_(tracker) {
  moment_.map = map_of(tracker_);
}

const Moment& Sight::look() {
  std::optional<hal::Frame> frame = camera_.take_newest();
  moment_.now_ns = clock_.now_ns();
  moment_.fresh = frame.has_value();
  if (frame) {
    moment_.frame = std::move(*frame);
    std::int64_t tracked_ns = moment_.now_ns;
    moment_.tracked =
        tracker_.track(*moment_.frame.gray, moment_.frame.index, moment_.frame.timestamp_ns,
                       [this, &tracked_ns] { tracked_ns = clock_.now_ns(); });
    moment_.tracking_ms = 1e-6 * static_cast<double>(tracked_ns - moment_.now_ns);
    moment_.map_points = tracker_.visible_points();
    moment_.measurements = &tracker_.measurements();
  }
  moment_.map.revision = tracker_.map_revision();
  return moment_;
}

}  // namespace lumibox::app
