#include <fmt/core.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "app/scenes.h"
#include "bench/footage.h"
#include "bench/sim_frame.h"
#include "bench/sweep_plot.h"
#include "bench/tracking_bench.h"
#include "config/error.h"
#include "geometry/robust.h"
#include "hal/replay/replay_camera.h"
#include "hal/sim/random_scene.h"
#include "hal/sim/scene.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox::app {
namespace {

constexpr const char* kScene = "toy";

/// Footage that is judged together: table and plot have the medians over all of it.
struct Group {
  std::string name;
  std::vector<bench::Footage> footages;
};

Group film_toy(std::int64_t frames) {
  const std::string name = std::string("simulated ") + kScene;
  return {name, {bench::film_scene(name, hal::load_scene(find_scene(kScene)), frames)}};
}

Group draw_scenes(const SeedRange& seeds, std::int64_t frames) {
  Group group{fmt::format("random scenes {} to {}", seeds.first, seeds.last), {}};
  Progress progress("filming random scenes", seeds.last - seeds.first + 1);
  for (std::uint32_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const auto scene = hal::make_scene(hal::sim::random_scene({seed, {}, {}, {}}));
    group.footages.push_back(bench::film_scene(fmt::format("random {}", seed), scene, frames));
    progress.show(seed - seeds.first + 1);
  }
  return group;
}

Group film_sequence(const std::filesystem::path& path, std::int64_t frames) {
  const hal::Sequence sequence = hal::open_sequence(path);
  hal::VirtualClock clock;
  hal::ReplayCamera camera(sequence, clock, hal::Pacing::Lockstep);
  camera.start();
  const std::filesystem::path name = path.has_filename() ? path : path.parent_path();
  bench::Footage footage = bench::film(name.filename().string(), camera, clock, frames);
  footage.truth = sequence.ground_truth;
  return {footage.name, {footage}};
}

/// Measurements go to the file one by one, so that a run that is broken off keeps what it has.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file), stream_(file) {}

  void add(const nlohmann::json& json) {
    stream_ << json.dump() << std::endl;
    if (!stream_) throw config::InputError(file_, "cannot be written");
  }

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
};

/// The medians of a variation over its runs.
bench::SweepPoint median_of(const bench::Variation& variation,
                            const std::vector<bench::TrackingResult>& runs) {
  std::vector<double> ms;
  std::vector<double> errors;
  std::vector<double> shares;
  std::vector<double> mapping_ms;
  for (const bench::TrackingResult& run : runs) {
    ms.push_back(run.cpu_ms.median);
    shares.push_back(static_cast<double>(run.tracked) / static_cast<double>(run.frames));
    mapping_ms.push_back(run.mapping_ms / static_cast<double>(run.frames));
    if (run.live) errors.push_back(run.live->percent);
  }
  bench::SweepPoint point;
  point.value = variation.value;
  point.is_default = variation.is_default;
  point.ms = geometry::median(ms);
  point.tracked_share = geometry::median(shares);
  point.mapping_ms = geometry::median(mapping_ms);
  if (!errors.empty()) point.error = geometry::median(errors);
  return point;
}

void print_head() {
  std::printf("%-26s %6s %10s %10s %12s %9s\n", "setting", "value", "tracker ms", "mapper ms",
              "live error %", "tracked %");
}

void print_curve(const bench::SweepCurve& curve) {
  const auto knee = bench::knee(curve);
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const bench::SweepPoint& point = curve.points[i];
    const std::string error = point.error ? fmt::format("{:.4f}", *point.error) : "-";
    std::printf("%-26s %6g %10.2f %10.2f %12s %9.1f%s%s\n", curve.setting.c_str(), point.value,
                point.ms, point.mapping_ms, error.c_str(), 100.0 * point.tracked_share,
                point.is_default ? "  default" : "", i == knee ? "  knee" : "");
  }
}

void print_times(const char* what, const bench::FrameTimes& wall, const bench::FrameTimes& cpu) {
  std::printf("%s: %.2f ms median, %.2f ms p95; by its thread's processor time %.2f and %.2f ms\n",
              what, wall.median, wall.p95, cpu.median, cpu.p95);
}

/// The default as on the box, and against ORB.
void measure_default(const bench::Footage& footage, const config::Config& config, Lines& lines) {
  const auto realtime = bench::measure_tracking(footage, config.tracking, bench::Pace::Recorded, 0);
  lines.add(bench::realtime_to_json(footage, realtime));
  const auto tracker = bench::measure_tracking(footage, config.tracking, bench::Pace::Awaited, 0);
  const auto orb = bench::measure_orb(footage);
  lines.add(bench::to_json(footage, orb, tracker));
  std::printf("%s, %lld frames\n", footage.name.c_str(), static_cast<long long>(tracker.frames));
  print_times("  tracker, mapper beside it, as recorded", realtime.wall_ms, realtime.cpu_ms);
  print_times("  tracker alone", tracker.wall_ms, tracker.cpu_ms);
  std::printf("  before there is a map: %.2f ms median, %.2f ms p95\n",
              tracker.initialising_ms.median, tracker.initialising_ms.p95);
  print_times("  ORB, 1000 features, one thread", orb.wall_ms, orb.cpu_ms);
  if (tracker.unrefined && tracker.refined) {
    std::printf("  final adjustment: %.3f %% to %.3f %% of the extent in %.0f ms\n",
                tracker.unrefined->percent, tracker.refined->percent, tracker.refinement_ms);
  }
  std::printf("  tracker / ORB: %.2f, by processor time %.2f\n",
              tracker.wall_ms.median / orb.wall_ms.median,
              tracker.cpu_ms.median / orb.cpu_ms.median);
}

/// One value of a setting on all the footage, each run with another seed.
std::vector<bench::TrackingResult> measure(const Group& group, const bench::Variation& variation,
                                           int runs, Lines& lines) {
  std::vector<bench::TrackingResult> results;
  for (const bench::Footage& footage : group.footages) {
    bench::Footage shown = footage;
    for (int i = 0; i < variation.halvings; ++i) shown = bench::halved(shown);
    for (int run = 0; run < runs; ++run) {
      const auto seed = static_cast<std::uint32_t>(run);
      results.push_back(
          bench::measure_tracking(shown, variation.options, bench::Pace::Awaited, seed));
      lines.add(bench::to_json(footage, variation, seed, results.back()));
    }
  }
  return results;
}

std::vector<bench::SweepCurve> sweep(const Group& group, const config::Config& config, int runs,
                                     Lines& lines) {
  const int width = group.footages.front().camera.width();
  const auto variations = bench::tracking_variations(config.tracking, width);
  std::vector<bench::SweepCurve> curves;
  Progress progress("measuring " + group.name, std::ssize(variations));
  std::int64_t done = 0;
  for (const bench::Variation& variation : variations) {
    const auto results = measure(group, variation, runs, lines);
    if (curves.empty() || curves.back().setting != variation.setting) {
      curves.push_back({variation.setting, group.name, {}});
    }
    curves.back().points.push_back(median_of(variation, results));
    progress.show(++done);
  }
  return curves;
}

void bench_tracking(const BenchOptions& options, const config::Config& config) {
  const std::filesystem::path json = options.out / "tracking.jsonl";
  const std::filesystem::path plot = options.out / "tracking.svg";
  require_writable(json);
  require_writable(plot);
  std::vector<Group> groups;
  for (const auto& sequence : options.sequences) {
    groups.push_back(film_sequence(sequence, options.frames));
  }
  if (options.random) groups.push_back(draw_scenes(*options.random, options.frames));
  groups.push_back(film_toy(options.frames));

  Lines lines(json);
  std::vector<bench::SweepCurve> curves;
  for (const Group& group : groups) {
    for (const bench::Footage& footage : group.footages) measure_default(footage, config, lines);
    std::printf("%s\n", group.name.c_str());
    print_head();
    for (const bench::SweepCurve& curve : sweep(group, config, options.runs, lines)) {
      print_curve(curve);
      curves.push_back(curve);
    }
  }
  bench::write_svg(
      plot, bench::draw_sweep("What accuracy costs: live error over the tracker's time", curves));
  std::printf("%s\n%s\n", json.c_str(), plot.c_str());
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

}  // namespace

void run_bench(const BenchOptions& options) {
  const config::Config config = load_config(options.sources);
  if (options.what == "simulation") {
    bench_simulation(options);
  } else {
    bench_tracking(options, config);
  }
}

}  // namespace lumibox::app
