#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/bench_subjects.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "app/scenes.h"
#include "bench/rendering_curves.h"
#include "bench/rendering_memory.h"
#include "bench/rendering_quality.h"
#include "bench/rendering_speed.h"
#include "hal/sim/random_scene.h"
#include "hal/sim/scene.h"

namespace lumibox::app {
namespace {

struct NamedScene {
  std::string name;
  std::shared_ptr<const hal::Scene> scene;
};

/// Scenes that are judged together: table and plot have the medians over them.
struct Group {
  std::string name;
  std::vector<NamedScene> scenes;
};

Group load_group(const std::filesystem::path& file) {
  const std::string name = file.stem().string();
  return {name, {{name, hal::load_scene(file)}}};
}

std::vector<Group> load_groups(const BenchOptions& options) {
  std::vector<Group> groups;
  for (const auto& file : options.scenes) groups.push_back(load_group(file));
  if (groups.empty()) groups.push_back(load_group(find_scene("toy")));
  if (!options.random) return groups;
  const SeedRange& seeds = *options.random;
  Group drawn{fmt::format("random scenes {} to {}", seeds.first, seeds.last), {}};
  for (std::uint32_t seed = seeds.first; seed <= seeds.last; ++seed) {
    drawn.scenes.push_back({fmt::format("random {}", seed),
                            hal::make_scene(hal::sim::random_scene({seed, {}, {}, {}}))});
  }
  groups.push_back(drawn);
  return groups;
}

void measure_memory(const NamedScene& scene, const config::Config& config, std::size_t perspectives,
                    Lines& lines) {
  const bench::MemoryResult result = bench::measure_memory(*scene.scene, config, perspectives);
  lines.add(bench::to_json(scene.name, result));
  std::printf("%s, %zu perspectives of %dx%d\n", scene.name.c_str(), result.perspectives,
              result.width, result.height);
  std::printf("  memory: %.0f MB held, %.0f MB seen from all sides, %.0f MB with the shape\n",
              result.held_mb, result.drawn_mb, result.mesh_mb);
  std::printf("  upload: %.2f ms median, %.2f ms p95, %.2f ms at most\n", result.upload_ms.median,
              result.upload_ms.p95, result.upload_ms.max);
}

void measure_speed(const NamedScene& scene, const config::Config& config, std::size_t perspectives,
                   Lines& lines) {
  bench::SpeedEffort effort;
  effort.perspectives = std::min(effort.perspectives, perspectives);
  const bench::SpeedRun run = bench::measure_speed(*scene.scene, config, effort);
  for (const auto& result : run.results) lines.add(bench::to_json(scene.name, run, result));
  lines.add(bench::ratios_to_json(scene.name, run));
  std::printf("%s, %zu perspectives, a view of %dx%d that moves\n", scene.name.c_str(),
              run.effort.perspectives, run.width, run.height);
  std::printf("| %-12s | %3s | %9s | %8s | %8s | %8s | %10s |\n", "method", "k", "median ms",
              "p95 ms", "cpu ms", "fit ms", "naive/this");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const bench::SpeedResult& r : run.results) {
    std::printf("| %-12s | %3d | %9.1f | %8.1f | %8.1f | %8.1f | %10.1f |\n", r.method.c_str(), r.k,
                r.wall_ms.median, r.wall_ms.p95, r.cpu_ms.median, r.fit_ms.median,
                run.naive_over(r.method));
  }
  std::printf("  naive quads / plane-small: %.1f, by processor time %.1f (wanted: at least %.0f)\n",
              run.naive_over("plane-small"), run.naive_over_cpu("plane-small"),
              bench::kNaiveTarget);
}

/// All variations in all scenes of a group.
std::vector<bench::QualityPoint> measure_quality(const Group& group, const config::Config& config,
                                                 std::size_t views, Lines& lines) {
  std::vector<bench::RenderingVariation> variations;
  std::vector<std::vector<bench::QualityResult>> results;  // by variation, of the scenes
  const auto in_all = bench::rendering_variations(config, Eigen::Vector3d::Zero()).size();
  Progress progress("rendering " + group.name, std::ssize(group.scenes) * std::int64_t(in_all));
  std::int64_t done = 0;
  for (const NamedScene& scene : group.scenes) {
    std::size_t index = 0;
    bench::measure_quality(scene.scene, scene.name, config, views,
                           [&](const auto& variation, const auto& result) {
                             lines.add(bench::to_json(scene.name, variation, result));
                             if (index == variations.size()) {
                               variations.push_back(variation);
                               results.emplace_back();
                             }
                             results[index++].push_back(result);
                             progress.show(++done);
                           });
  }
  std::vector<bench::QualityPoint> points;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    points.push_back(bench::median_of(variations[i], results[i]));
  }
  return points;
}

void print_quality(const std::string& group, const std::vector<bench::QualityPoint>& points) {
  std::printf("%s: on the subject, in views that nobody recorded\n", group.c_str());
  std::printf("| %-11s | %-13s | %5s | %12s | %7s | %6s | %9s | %8s | %-12s |\n", "method",
              "setting", "value", "perspectives", "PSNR dB", "SSIM", "median ms", "cpu ms", "");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  const std::vector<bool> knees = bench::knees(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bench::QualityPoint& p = points[i];
    const std::string marks =
        std::string(p.variation.is_default ? "default " : "") + (knees[i] ? "knee" : "");
    std::printf("| %-11s | %-13s | %5g | %12g | %7.2f | %6.4f | %9.1f | %8.1f | %-12s |\n",
                p.variation.method.name.c_str(), p.variation.setting.c_str(), p.variation.value,
                p.perspectives, p.psnr, p.ssim, p.wall_ms, p.cpu_ms, marks.c_str());
  }
}

}  // namespace

void bench_rendering(const BenchOptions& options, const config::Config& config) {
  const std::filesystem::path json = options.out / "rendering.jsonl";
  const std::filesystem::path plot = options.out / "rendering.svg";
  require_writable(json);
  require_writable(plot);
  const std::vector<Group> groups = load_groups(options);
  Lines lines(json);
  const NamedScene& first = groups.front().scenes.front();
  measure_memory(first, config, options.perspectives, lines);  // while nothing else has grown
  measure_speed(first, config, options.perspectives, lines);
  std::vector<bench::SweepCurve> all_curves;
  for (const Group& group : groups) {
    const auto points = measure_quality(group, config, options.views, lines);
    const auto curves = bench::quality_curves(group.name, points);
    print_quality(group.name, points);
    all_curves.insert(all_curves.end(), curves.begin(), curves.end());
  }
  bench::write_svg(plot, bench::draw_quality(all_curves));
  std::printf("%s\n%s\n", json.c_str(), plot.c_str());
}

}  // namespace lumibox::app
