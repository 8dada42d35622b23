#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "app/commands/bench_subjects.h"
#include "app/commands/support.h"
#include "app/scenes.h"
#include "bench/sim_frame.h"
#include "config/error.h"
#include "hal/sim/scene.h"

namespace lumibox::app {

void Lines::add(const nlohmann::json& json) {
  stream_ << json.dump() << std::endl;
  if (!stream_) throw config::InputError(file_, "cannot be written");
}

void bench_simulation(const BenchOptions& options) {
  const std::filesystem::path json = options.out / "simulation.jsonl";
  require_writable(json);
  Lines lines(json);
  for (const std::string& name : scene_names()) {
    const auto line =
        bench::measure_sim_frame(hal::load_scene(find_scene(name)), name, options.frames);
    lines.add(line);
    std::printf("%-16s %8.1f ms median of a frame, %8.1f ms p95\n", name.c_str(),
                line["cpu_ms"]["median"].get<double>(), line["cpu_ms"]["p95"].get<double>());
  }
  std::printf("%s\n", json.c_str());
}

void run_bench(const BenchOptions& options) {
  const config::Config config = load_config(options.sources);
  if (options.what == "simulation") {
    bench_simulation(options);
  } else if (options.what == "rendering") {
    bench_rendering(options, config);
  } else {
    bench_tracking(options, config);
  }
}

}  // namespace lumibox::app
