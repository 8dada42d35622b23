#include "app/track_report.h"

#include <nlohmann/json.hpp>

#include "geometry/robust.h"

namespace lumibox::app {
void TrackReport::add(const Moment& moment) {
  const tracking::TrackedFrame& tracked = moment.tracked;
  ++frames_;
  ms_.push_back(moment.tracking_ms);
  if (tracked.world_from_camera) {
    ++tracked_;
    initialised_at_frame_ = initialised_at_frame_.value_or(tracked.index);
    in_loss_ = false;
  } else if (initialised_at_frame_) {
    ++lost_;
    if (!in_loss_) {
      // By now the tracker may only say that it relocalises; what came before says why.
      const bool told = tracked.reason != tracking::TrackingReason::Relocalising;
      losses_.push_back({told ? tracked.reason : last_reason_, tracked.index, tracked.index});
      in_loss_ = true;
    }
    losses_.back().last_frame = tracked.index;
  }
  last_reason_ = tracked.reason;
}

nlohmann::json TrackReport::to_json(const tracking::TrackerStatistics& statistics) const {
  nlohmann::json json;
  json["frames"] = frames_;
  json["tracked"] = tracked_;
  json["lost"] = lost_;
  json["initialised_at_frame"] = nullptr;
  if (initialised_at_frame_) {
    json["initialised_at_frame"] = *initialised_at_frame_;
  }
  json["keyframes"] = statistics.keyframes;
  json["points"] = statistics.points;
  json["loops_closed"] = statistics.loops_closed;
  json["relocalisations"] = statistics.relocalisations;
  json["ms"] = {{"median", geometry::quantile(ms_, 0.5)},
                {"p95", geometry::quantile(ms_, 0.95)},
                {"max", geometry::quantile(ms_, 1.0)}};
  json["losses"] = nlohmann::json::array();
  for (const Loss& loss : losses_) {
    json["losses"].push_back({{"reason", name_of(loss.reason)},
                              {"first_frame", loss.first_frame},
                              {"last_frame", loss.last_frame}});
  }
  return json;
}

std::string name_of(tracking::TrackingReason reason) {
  using tracking::TrackingReason;
  switch (reason) {
    case TrackingReason::None:
      return "none";
    case TrackingReason::TooLittleTexture:
      return "too_little_texture";
    case TrackingReason::MoveSideways:
      return "move_sideways";
    case TrackingReason::TurningOnly:
      return "turning_only";
    case TrackingReason::PlaneAmbiguous:
      return "plane_ambiguous";
    case TrackingReason::TooDarkOrBlurred:
      return "too_dark_or_blurred";
    case TrackingReason::TooFewPointsFound:
      return "too_few_points_found";
    case TrackingReason::Relocalising:
      return "relocalising";
  }
  return "unknown";
}

}  // namespace lumibox::app
