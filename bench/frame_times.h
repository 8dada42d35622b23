#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "bench/stopwatch.h"

namespace lumibox::bench {

/// Time of one frame over all frames, in milliseconds.
struct FrameTimes {
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

FrameTimes summary(const std::vector<double>& ms);

nlohmann::json to_json(const FrameTimes& times);

/// Times of single frames.
struct Samples {
  std::vector<double> wall_ms;
  std::vector<double> cpu_ms;

  void add(const Stopwatch& watch) {
    cpu_ms.push_back(watch.cpu_ms());
    wall_ms.push_back(watch.wall_ms());
  }
};

}  // namespace lumibox::bench
