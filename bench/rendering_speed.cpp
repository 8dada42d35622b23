#include "bench/rendering_speed.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "bench/naive_quads.h"
#include "bench/simulated_capture.h"
#include "hal/offscreen/offscreen_display.h"
#include "render/leave_one_out.h"
#include "render/proxy_geometry.h"
#include "render/renderer.h"

namespace lumibox::bench {
namespace {

using lightfield::Perspective;

constexpr double kRadians = std::numbers::pi / 180.0;

/// One way to draw a frame, and its times.
struct Contestant {
  std::string name;
  std::function<render::Settings(const render::View&)> fit;
  std::function<void(const render::View&, const render::Settings&)> draw;
  int k = 0;
  Samples samples{};
  std::vector<double> fit_ms{};

  void draw_timed(const render::View& view) {
    const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
    const render::Settings settings = fit(view);
    fit_ms.push_back(watch.wall_ms());
    draw(view, settings);
    glFinish();
    samples.add(watch);
    k = settings.k;
  }
};

/// As a person goes who looks around: half a degree a frame, up and down a little meanwhile.
std::vector<render::View> moving_views(const Walk& walk, std::size_t frames) {
  std::vector<render::View> views;
  for (std::size_t i = 0; i < frames; ++i) {
    const double azimuth = 0.5 * kRadians * static_cast<double>(i);
    const double elevation = (30.0 + 5.0 * std::sin(6.0 * azimuth)) * kRadians;
    views.push_back({*walk.camera, pose_around(walk, azimuth, elevation)});
  }
  return views;
}

std::vector<Contestant> contestants(const std::vector<Perspective>& perspectives,
                                    const config::Config& config, const Eigen::Vector3d& focus,
                                    unsigned framebuffer) {
  std::vector<Contestant> result;
  for (const render::Method& method : render::compared_methods(config.render, focus)) {
    if (method.name != "plane-small" && method.name != "plane-wide" && method.name != "mesh") {
      continue;
    }
    const auto proxy = std::make_shared<render::ProxyGeometry>(std::vector<Eigen::Vector3d>(),
                                                               render::Estimating::AtOnce);
    const auto renderer = std::make_shared<render::Renderer>(config.render);
    result.push_back(
        {method.name,
         [=, &perspectives](const render::View& view) {
           return proxy->fit(method.settings, method.geometry, view, perspectives);
         },
         [=, &perspectives](const render::View& view, const render::Settings& settings) {
           renderer->draw(view, perspectives, settings, framebuffer);
         }});
  }
  const auto naive = std::make_shared<NaiveQuads>(NaiveQuads::Blending::Stored);
  const render::Settings small =
      render::settings_from(config.render, render::Aperture::Small, focus);
  result.push_back({"naive-quads", [=](const render::View&) { return small; },
                    [=, &perspectives](const render::View& view, const render::Settings& settings) {
                      naive->draw(view, perspectives, settings, framebuffer);
                    }});
  return result;
}

}  // namespace

const SpeedResult& SpeedRun::of(const std::string& method) const {
  return *std::ranges::find(results, method, &SpeedResult::method);
}

double SpeedRun::naive_over(const std::string& method) const {
  return of("naive-quads").wall_ms.median / of(method).wall_ms.median;
}

double SpeedRun::naive_over_cpu(const std::string& method) const {
  return of("naive-quads").cpu_ms.median / of(method).cpu_ms.median;
}

SpeedRun measure_speed(const hal::Scene& scene, const config::Config& config,
                       const SpeedEffort& effort) {
  const Walk walk = walk_of(scene);
  std::vector<Perspective> perspectives;
  for (const hal::StampedPose& pose : around_subject(walk, effort.perspectives)) {
    perspectives.push_back(record(scene, walk, static_cast<int>(perspectives.size()), pose));
  }
  hal::OffscreenDisplay display(walk.camera->width(), walk.camera->height());
  display.make_current();
  auto all = contestants(perspectives, config, walk.subject.center, display.framebuffer());
  const std::vector<render::View> views = moving_views(walk, effort.frames);
  for (int round = 0; round <= effort.rounds; ++round) {
    for (const render::View& view : views) {
      for (Contestant& contestant : all) contestant.draw_timed(view);
    }
    if (round > 0) continue;
    for (Contestant& contestant : all) {  // the first only warms up
      contestant.samples = {};
      contestant.fit_ms.clear();
    }
  }
  SpeedRun run{walk.camera->width(), walk.camera->height(), effort, {}};
  for (const Contestant& contestant : all) {
    run.results.push_back({contestant.name, contestant.k, summary(contestant.samples.wall_ms),
                           summary(contestant.samples.cpu_ms), summary(contestant.fit_ms)});
  }
  return run;
}

nlohmann::json to_json(const std::string& scene, const SpeedRun& run, const SpeedResult& result) {
  return {{"what", "rendering_speed"},
          {"scene", scene},
          {"method", result.method},
          {"k", result.k},
          {"perspectives", run.effort.perspectives},
          {"width", run.width},
          {"height", run.height},
          {"frames", run.effort.frames},
          {"rounds", run.effort.rounds},
          {"ms", to_json(result.wall_ms)},
          {"cpu_ms", to_json(result.cpu_ms)},
          {"fit_ms", to_json(result.fit_ms)}};
}

nlohmann::json ratios_to_json(const std::string& scene, const SpeedRun& run) {
  return {{"what", "rendering_ratio"},
          {"scene", scene},
          {"naive_over_small", run.naive_over("plane-small")},
          {"naive_over_small_cpu", run.naive_over_cpu("plane-small")},
          {"target", kNaiveTarget}};
}

}  // namespace lumibox::bench
