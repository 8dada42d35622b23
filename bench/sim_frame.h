#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hal/sim/scene.h"

namespace lumibox::bench {

/// What a frame of a scene costs the simulated camera, in processor time of the whole program;
/// `frames` of them, spread over the scene's whole walk. A line of the bench's JSON.
nlohmann::json measure_sim_frame(const std::shared_ptr<const hal::Scene>& scene,
                                 const std::string& name, std::int64_t frames);

}  // namespace lumibox::bench
