#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/frame_times.h"
#include "config/config.h"
#include "hal/sim/scene.h"

namespace lumibox::bench {

/// The most memory that the program had resident (VmHWM of /proc/self/status) since it began, or
/// since forget_peak_memory(); MB of 10^6 bytes, 0 where the system does not say.
double peak_memory_mb();

/// Gives what the heap holds free back to the system, so that it will count when it is used again,
/// and has peak_memory_mb() begin anew. Where the system does not allow that, the peak stays.
void forget_peak_memory();

/// What many perspectives around a subject take, each figure added to what the program had before.
struct MemoryResult {
  std::size_t perspectives = 0;
  int width = 0;
  int height = 0;
  double held_mb = 0.0;   ///< peak when all are recorded
  double drawn_mb = 0.0;  ///< when the view, small aperture on planes, has been all around besides
  double mesh_mb = 0.0;   ///< when it has been around on the scene's shape, too
  FrameTimes upload_ms;   ///< of Renderer::upload() of one newly recorded, until the GPU is done
};

/// To be measured before anything else in the process: what grew and shrank before would hide it.
MemoryResult measure_memory(const hal::Scene& scene, const config::Config& config,
                            std::size_t perspectives);

/// A line of the bench's JSON.
nlohmann::json to_json(const std::string& scene, const MemoryResult& result);

}  // namespace lumibox::bench
