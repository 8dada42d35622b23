#include "bench/frame_times.h"

#include <nlohmann/json.hpp>

#include "geometry/robust.h"

namespace lumibox::bench {

FrameTimes summary(const std::vector<double>& ms) {
  return {geometry::quantile(ms, 0.5), geometry::quantile(ms, 0.95), geometry::quantile(ms, 1.0)};
}

nlohmann::json to_json(const FrameTimes& times) {
  return {{"median", times.median}, {"p95", times.p95}, {"max", times.max}};
}

}  // namespace lumibox::bench
