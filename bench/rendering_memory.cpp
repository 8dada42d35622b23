#include "bench/rendering_memory.h"

#include <GLES3/gl3.h>
#include <malloc.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/simulated_capture.h"
#include "hal/offscreen/offscreen_display.h"
#include "render/leave_one_out.h"
#include "render/proxy_geometry.h"
#include "render/renderer.h"

namespace lumibox::bench {
namespace {

using lightfield::Perspective;

/// A picture so small that its textures count for nothing.
constexpr int kTinyLevel = 3;

/// The capture and what draws it.
class Review {
 public:
  Review(const hal::Scene& scene, const config::Config& config)
      : scene_(scene),
        walk_(walk_of(scene)),
        methods_(render::compared_methods(config.render, walk_.subject.center)),
        display_(walk_.camera->width(), walk_.camera->height()) {
    display_.make_current();
    renderer_ = std::make_unique<render::Renderer>(config.render);
  }

  const geometry::Camera& camera() const { return *walk_.camera; }
  render::Renderer& renderer() { return *renderer_; }
  const std::vector<Perspective>& perspectives() const { return perspectives_; }

  /// Drivers compile shaders when they first draw, and that takes memory of its own.
  void warm_up() {
    Walk tiny = walk_;
    tiny.camera = std::make_shared<const geometry::Camera>(walk_.camera->at_level(kTinyLevel));
    perspectives_ = {record(scene_, tiny, 0, tiny.poses.front())};
    look_around("plane-small");
    look_around("mesh");
    perspectives_.clear();
  }

  void record_all(std::size_t count) {
    for (const hal::StampedPose& pose : around_subject(walk_, count)) {
      perspectives_.push_back(record(scene_, walk_, static_cast<int>(perspectives_.size()), pose));
    }
  }

  /// The view goes to every perspective, so that each has been the nearest.
  void look_around(const std::string& method_name) {
    const auto method = *std::ranges::find(methods_, method_name, &render::Method::name);
    for (const Perspective& perspective : perspectives_) {
      const render::View view{camera(), perspective.world_from_camera};
      renderer_->draw(view, perspectives_,
                      proxy_.fit(method.settings, method.geometry, view, perspectives_),
                      display_.framebuffer());
      glFinish();
    }
  }

 private:
  const hal::Scene& scene_;
  Walk walk_;
  std::vector<render::Method> methods_;
  hal::OffscreenDisplay display_;
  std::unique_ptr<render::Renderer> renderer_;
  render::ProxyGeometry proxy_{{}, render::Estimating::AtOnce};
  std::vector<Perspective> perspectives_;
};

/// Each picture once more, as an object that the renderer does not know.
FrameTimes measure_uploads(Review& review) {
  std::vector<double> wall_ms;
  for (Perspective perspective : review.perspectives()) {
    perspective.photo = std::make_shared<lightfield::Photo>(perspective.photo->require_rgb());
    const Stopwatch watch;
    review.renderer().upload(perspective);
    glFinish();
    wall_ms.push_back(watch.wall_ms());
  }
  return summary(wall_ms);
}

}  // namespace

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    long long kibibytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %lld kB", &kibibytes) == 1) {
      return 1024e-6 * static_cast<double>(kibibytes);
    }
  }
  return 0.0;
}

void forget_peak_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets the peak resident set size
}

MemoryResult measure_memory(const hal::Scene& scene, const config::Config& config,
                            std::size_t perspectives) {
  Review review(scene, config);
  review.warm_up();
  MemoryResult result{
      perspectives, review.camera().width(), review.camera().height(), 0.0, 0.0, 0.0, {}};
  forget_peak_memory();
  const double before_mb = peak_memory_mb();
  review.record_all(perspectives);
  result.held_mb = peak_memory_mb() - before_mb;
  review.look_around("plane-small");
  result.drawn_mb = peak_memory_mb() - before_mb;
  review.look_around("mesh");
  result.mesh_mb = peak_memory_mb() - before_mb;
  result.upload_ms = measure_uploads(review);
  return result;
}

nlohmann::json to_json(const std::string& scene, const MemoryResult& result) {
  return {{"what", "rendering_memory"},
          {"scene", scene},
          {"perspectives", result.perspectives},
          {"width", result.width},
          {"height", result.height},
          {"held_mb", result.held_mb},
          {"drawn_mb", result.drawn_mb},
          {"mesh_mb", result.mesh_mb},
          {"mesh_mb_per_perspective", result.mesh_mb / static_cast<double>(result.perspectives)},
          {"upload_ms", to_json(result.upload_ms)}};
}

}  // namespace lumibox::bench
