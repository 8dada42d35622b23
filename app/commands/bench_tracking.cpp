#include <fmt/core.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/commands/bench_subjects.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "app/scenes.h"
#include "bench/footage.h"
#include "bench/sweep_plot.h"
#include "bench/tracking_bench.h"
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

/// The medians of a variation over its runs.
struct Medians {
  double tracker_ms = 0.0;  ///< of a frame, by the tracker's processor time
  double mapper_ms = 0.0;   ///< per frame
  double final_ms = 0.0;    ///< of the final adjustment
  std::optional<double> live;
  std::optional<double> refined;
  double tracked_share = 0.0;
};

std::optional<double> median_if_any(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return geometry::median(values);
}

Medians median_of(const std::vector<bench::TrackingResult>& runs) {
  std::vector<double> tracker, mapper, final_adjustment, live, refined, shares;
  for (const bench::TrackingResult& run : runs) {
    const auto frames = static_cast<double>(run.frames);
    tracker.push_back(run.cpu_ms.median);
    mapper.push_back(run.mapping_ms / frames);
    final_adjustment.push_back(run.refinement_ms);
    shares.push_back(static_cast<double>(run.tracked) / frames);
    if (run.live) live.push_back(run.live->percent);
    if (run.refined) refined.push_back(run.refined->percent);
  }
  return {geometry::median(tracker), geometry::median(mapper), geometry::median(final_adjustment),
          median_if_any(live),       median_if_any(refined),   geometry::median(shares)};
}

bench::SweepPoint point_of(const bench::Variation& variation, const Medians& medians) {
  bench::SweepPoint point{variation.value, variation.is_default, medians.tracker_ms, medians.live,
                          medians.tracked_share};
  if (variation.buys == bench::Buys::Mapper) point.cost = medians.mapper_ms;
  if (variation.buys == bench::Buys::Final) {
    point.cost = medians.final_ms;
    point.error = medians.refined;
  }
  return point;
}

bench::SweepCurve begin_curve(const bench::Variation& variation, const std::string& footage) {
  switch (variation.buys) {
    case bench::Buys::Mapper:
      return {variation.setting,
              footage,
              {},
              "mapper, time per frame [ms]",
              "live error [% of the extent]"};
    case bench::Buys::Final:
      return {
          variation.setting, footage, {}, "final adjustment [ms]", "final error [% of the extent]"};
    case bench::Buys::Tracker:
      break;
  }
  return {variation.setting,
          footage,
          {},
          "tracker, median processor time of a frame [ms]",
          "live error [% of the extent]"};
}

/// A setting's curve with all that was measured at each of its points.
struct Sweep {
  bench::SweepCurve curve;
  std::vector<Medians> medians;
};

void print_head() {
  std::printf("%-26s %6s %10s %9s %8s %8s %8s %9s\n", "setting", "value", "tracker ms", "mapper ms",
              "final ms", "live %", "final %", "tracked %");
}

void print_sweep(const Sweep& sweep) {
  const auto knee = bench::knee(sweep.curve);
  const auto text = [](const std::optional<double>& error) {
    return error ? fmt::format("{:.4f}", *error) : "-";
  };
  for (std::size_t i = 0; i < sweep.medians.size(); ++i) {
    const bench::SweepPoint& point = sweep.curve.points[i];
    const Medians& m = sweep.medians[i];
    std::printf("%-26s %6g %10.2f %9.2f %8.0f %8s %8s %9.1f%s%s\n", sweep.curve.setting.c_str(),
                point.value, m.tracker_ms, m.mapper_ms, m.final_ms, text(m.live).c_str(),
                text(m.refined).c_str(), 100.0 * m.tracked_share,
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

std::vector<Sweep> sweep(const Group& group, const config::Config& config, int runs, Lines& lines) {
  const int width = group.footages.front().camera.width();
  const auto variations = bench::tracking_variations(config.tracking, width);
  std::vector<Sweep> sweeps;
  Progress progress("measuring " + group.name, std::ssize(variations));
  std::int64_t done = 0;
  for (const bench::Variation& variation : variations) {
    const Medians medians = median_of(measure(group, variation, runs, lines));
    if (sweeps.empty() || sweeps.back().curve.setting != variation.setting) {
      sweeps.push_back({begin_curve(variation, group.name), {}});
    }
    sweeps.back().curve.points.push_back(point_of(variation, medians));
    sweeps.back().medians.push_back(medians);
    progress.show(++done);
  }
  return sweeps;
}

}  // namespace

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
    for (const Sweep& swept : sweep(group, config, options.runs, lines)) {
      print_sweep(swept);
      curves.push_back(swept.curve);
    }
  }
  bench::write_svg(
      plot, bench::draw_sweep("What accuracy costs: error over time, one setting varied at a time",
                              curves));
  std::printf("%s\n%s\n", json.c_str(), plot.c_str());
}

}  // namespace lumibox::app
