#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/footage.h"
#include "bench/frame_times.h"
#include "config/config.h"

namespace lumibox::bench {

/// Where a setting's cost is paid, and which error it is meant to buy.
enum class Buys {
  Tracker,  ///< processor time of a frame; the live error
  Mapper,   ///< the mapper's time per frame; the live error
  Final,    ///< time of the final adjustment; the error after it
};

/// One way to set the tracker up that differs from the default in one setting.
struct Variation {
  std::string setting;  ///< e.g. "max_measurements"
  double value = 0.0;
  bool is_default = false;
  config::Tracking options;
  Buys buys = Buys::Tracker;
  int halvings = 0;  ///< of the pictures before they are tracked
};

/// The settings that trade accuracy for time, each at several values and at the default that
/// `options` states, in ascending order of the value; all else as in `options`. `width` is that of
/// the pictures, whose size is a setting too.
std::vector<Variation> tracking_variations(const config::Tracking& options, int width);

/// Accuracy against the truth; percentages are of the extent of the true positions.
struct Accuracy {
  double percent = 0.0;       ///< RMSE of the positions
  double rotation_deg = 0.0;  ///< RMSE of the orientations
};

struct TrackingResult {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;
  int keyframes = 0;
  int points = 0;
  FrameTimes wall_ms;  ///< of the tracker alone, the pictures in memory, once there is a map
  FrameTimes cpu_ms;   ///< the same by the processor time of its thread
  FrameTimes initialising_ms;         ///< the wall's, of the frames before there is a map
  double mapping_ms = 0.0;            ///< waited for the mapper, all frames together, by the wall
  double refinement_ms = 0.0;         ///< of the final adjustment, by the wall
  std::optional<Accuracy> live;       ///< as known when each frame was tracked
  std::optional<Accuracy> unrefined;  ///< as known before the final adjustment
  std::optional<Accuracy> refined;    ///< after it
};

enum class Pace {
  Awaited,   ///< each frame when the mapper is done with those before: the same result every time,
             ///< and nothing competes with the tracker for the processor
  Recorded,  ///< each at the time when it was taken, the mapper at work meanwhile, as on the box
};

/// Tracks the footage with a mapper on a thread of its own and measures the tracker.
TrackingResult measure_tracking(const Footage& footage, const config::Tracking& options, Pace pace,
                                std::uint32_t seed);

/// Time that OpenCV's ORB takes for 1000 features of a frame on one thread: what a simple tracker
/// would spend before it knows anything. Measured on every tenth frame.
struct OrbResult {
  FrameTimes wall_ms;
  FrameTimes cpu_ms;
};
OrbResult measure_orb(const Footage& footage);

/// The lines of the bench's JSON: one object per measurement.
nlohmann::json to_json(const Footage& footage, const Variation& variation, std::uint32_t seed,
                       const TrackingResult& result);
nlohmann::json realtime_to_json(const Footage& footage, const TrackingResult& result);
nlohmann::json to_json(const Footage& footage, const OrbResult& orb, const TrackingResult& tracker);

}  // namespace lumibox::bench
