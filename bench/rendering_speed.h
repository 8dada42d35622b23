#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/frame_times.h"
#include "config/config.h"
#include "hal/sim/scene.h"

namespace lumibox::bench {

/// How much is drawn to measure the renderer's speed.
struct SpeedEffort {
  std::size_t perspectives = 300;  ///< around the subject
  std::size_t frames = 40;         ///< of a view that moves half a degree from one to the next
  int rounds = 5;                  ///< of all frames, after one that is not timed
};

/// What a frame costs in one way of drawing it.
struct SpeedResult {
  std::string method;  ///< "plane-small", "plane-wide", "mesh"; "naive-quads" (see NaiveQuads)
  int k = 0;           ///< pictures blended
  FrameTimes wall_ms;  ///< until the GPU is done, without reading the picture back
  FrameTimes cpu_ms;   ///< the same by the processor time of all threads
  FrameTimes fit_ms;   ///< of wall_ms, what the processor needs for the shape before it draws
};

/// The same frames in all ways.
struct SpeedRun {
  int width = 0;
  int height = 0;
  SpeedEffort effort;
  std::vector<SpeedResult> results;

  const SpeedResult& of(const std::string& method) const;  ///< precondition: there is one

  /// How many times as long as a method the naive quads take, by the medians of the wall's times.
  double naive_over(const std::string& method) const;
  double naive_over_cpu(const std::string& method) const;  ///< by those of the processor's
};

/// Draws each frame in all ways before the next, so that whatever else the machine does meets all
/// of them. Each has textures of its own and uploads what its view newly sees; only the naive quads
/// have all of theirs before.
SpeedRun measure_speed(const hal::Scene& scene, const config::Config& config,
                       const SpeedEffort& effort = {});

/// How many times as long as the small aperture the naive quads are wanted to take at least.
inline constexpr double kNaiveTarget = 8.0;

/// Lines of the bench's JSON: one per result, and the ratios.
nlohmann::json to_json(const std::string& scene, const SpeedRun& run, const SpeedResult& result);
nlohmann::json ratios_to_json(const std::string& scene, const SpeedRun& run);

}  // namespace lumibox::bench
