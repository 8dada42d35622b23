#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/moment.h"
#include "tracking/tracker.h"

namespace lumibox::app {

/// Frames in a row without a pose.
struct Loss {
  tracking::TrackingReason reason = tracking::TrackingReason::None;
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;
};

/// What tracking a recording came to, frame by frame.
class TrackReport {
 public:
  void add(const Moment& moment);

  std::int64_t frames() const { return frames_; }
  std::int64_t tracked() const { return tracked_; }
  std::optional<std::int64_t> initialised_at_frame() const { return initialised_at_frame_; }
  const std::vector<Loss>& losses() const { return losses_; }

  /// Why the last frame was not tracked well.
  tracking::TrackingReason last_reason() const { return last_reason_; }

  /// The fields of `track --json`; those of the truth are added by the command.
  nlohmann::json to_json(const tracking::TrackerStatistics& statistics) const;

 private:
  std::int64_t frames_ = 0;
  std::int64_t tracked_ = 0;
  std::int64_t lost_ = 0;  ///< frames without a pose after the first with one
  std::optional<std::int64_t> initialised_at_frame_;
  std::vector<double> ms_;
  std::vector<Loss> losses_;
  bool in_loss_ = false;
  tracking::TrackingReason last_reason_ = tracking::TrackingReason::None;
};

/// Name for files, e.g. "too_few_points_found".
std::string name_of(tracking::TrackingReason reason);

}  // namespace lumibox::app
