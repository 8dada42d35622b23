#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/frame_times.h"
#include "config/config.h"
#include "hal/sim/scene.h"
#include "render/leave_one_out.h"

namespace lumibox::bench {

/// One way to record and to render that differs from the default in one setting.
struct RenderingVariation {
  render::Method method;
  std::string setting;  ///< "threshold_deg" of the gate, or "k", the pictures blended
  double value = 0.0;
  bool is_default = false;
  double threshold_deg = 0.0;
};

/// The settings that trade likeness for time, for each of `plane-small`, `plane-wide` and `mesh`:
/// several values of each and the default of `config`, in ascending order.
std::vector<RenderingVariation> rendering_variations(const config::Config& config,
                                                     const Eigen::Vector3d& focus);

/// What a variation came to in a simulated scene.
struct QualityResult {
  std::size_t perspectives = 0;  ///< that the gate recorded
  std::size_t views = 0;         ///< that were rendered, none of them recorded
  double psnr = 0.0;             ///< dB on the subject, mean over the views
  double ssim = 0.0;             ///< likewise
  FrameTimes wall_ms;            ///< of a view: its shape, plan and drawing, until the GPU is done
  FrameTimes cpu_ms;             ///< the same by the processor time of all threads
};

/// Each variation in turn on the same views of a walk through the scene: the true poses, pictures
/// of the simulator's own rays without effects, recorded as the gate would; views that nobody
/// recorded, compared with what the simulator sees there. At most `views` of them. Throws
/// config::InputError if the walk has none. `done` is called after each variation.
void measure_quality(
    const std::shared_ptr<const hal::Scene>& scene, const std::string& name,
    const config::Config& config, std::size_t views,
    const std::function<void(const RenderingVariation&, const QualityResult&)>& done);

/// A line of the bench's JSON.
nlohmann::json to_json(const std::string& scene, const RenderingVariation& variation,
                       const QualityResult& result);

}  // namespace lumibox::bench
