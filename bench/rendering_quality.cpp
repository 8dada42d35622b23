#include "bench/rendering_quality.h"

#include <GLES3/gl3.h>

#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "bench/simulated_capture.h"
#include "config/error.h"
#include "hal/offscreen/offscreen_display.h"
#include "render/image_quality.h"
#include "render/proxy_geometry.h"
#include "render/renderer.h"

namespace lumibox::bench {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
/// From all that was recorded: a view any nearer is next to a copy of it.
constexpr double kLeastAngle = 0.5 * kRadians;

const std::set<double> kThresholdsDeg{2, 3, 4, 5, 6, 8, 10};
const std::set<double> kPictures{5, 10, 20, 40, 80};
const std::set<double> kPicturesOnShape{1, 2, 3, 4, 6, render::kPicturesOfView};

std::set<double> with(std::set<double> values, double another) {
  values.insert(another);
  return values;
}

void vary(const render::Method& method, double threshold_deg,
          std::vector<RenderingVariation>& variations) {
  for (const double value : with(kThresholdsDeg, threshold_deg)) {
    variations.push_back({method, "threshold_deg", value, value == threshold_deg, value});
  }
  const bool on_shape = method.geometry == render::Geometry::Mesh;
  const int most = static_cast<int>(on_shape ? render::kPicturesOfView : render::kMaxLayers);
  const int chosen = std::min(method.settings.k, most);
  for (const double value : with(on_shape ? kPicturesOnShape : kPictures, chosen)) {
    RenderingVariation variation{method, "k", value, value == chosen, threshold_deg};
    variation.method.settings.k = static_cast<int>(value);
    variations.push_back(variation);
  }
}

/// What each threshold records of a walk; pictures are made when they are first needed.
class Captures {
 public:
  Captures(const hal::Scene& scene, const Walk& walk) : scene_(scene), walk_(walk) {}

  const std::vector<std::size_t>& indices(double threshold_deg) {
    const auto [known, is_new] = indices_.try_emplace(threshold_deg);
    if (is_new) known->second = recorded_along(walk_, threshold_deg * kRadians);
    return known->second;
  }

  std::vector<lightfield::Perspective> perspectives(double threshold_deg) {
    std::vector<lightfield::Perspective> result;
    for (const std::size_t index : indices(threshold_deg)) {
      auto known = recorded_.find(index);
      if (known == recorded_.end()) {
        const int id = static_cast<int>(index);
        known = recorded_.emplace(index, record(scene_, walk_, id, walk_.poses[index])).first;
      }
      result.push_back(known->second);
    }
    return result;
  }

 private:
  const hal::Scene& scene_;
  const Walk& walk_;
  std::map<double, std::vector<std::size_t>> indices_;
  std::map<std::size_t, lightfield::Perspective> recorded_;
};

/// A view that nobody recorded, and what the simulator sees there.
struct Unseen {
  render::View view;
  hal::Image actual;
  hal::Image subject;  ///< 255 within the sphere's outline
};

/// Renders variations and compares them with what there is to see.
class Judge {
 public:
  explicit Judge(std::vector<Unseen> views)
      : views_(std::move(views)),
        display_(views_.front().actual.width(), views_.front().actual.height()) {
    display_.make_current();
    renderer_ = std::make_unique<render::Renderer>();
  }

  QualityResult judge(const render::Method& method,
                      const std::vector<lightfield::Perspective>& perspectives) {
    QualityResult result{perspectives.size(), views_.size(), 0.0, 0.0, {}, {}};
    Samples samples;
    for (const Unseen& unseen : views_) {
      draw(method, unseen.view, perspectives);  // uploads pictures and estimates depths
      const hal::Image picture = display_.read_back();
      result.psnr += render::psnr(picture, unseen.actual, &unseen.subject);
      result.ssim += render::ssim(picture, unseen.actual, &unseen.subject);
      const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
      draw(method, unseen.view, perspectives);
      samples.add(watch);
    }
    result.psnr /= static_cast<double>(views_.size());
    result.ssim /= static_cast<double>(views_.size());
    result.wall_ms = summary(samples.wall_ms);
    result.cpu_ms = summary(samples.cpu_ms);
    return result;
  }

 private:
  void draw(const render::Method& method, const render::View& view,
            const std::vector<lightfield::Perspective>& perspectives) {
    renderer_->draw(view, perspectives,
                    proxy_.fit(method.settings, method.geometry, view, perspectives),
                    display_.framebuffer());
    glFinish();
  }

  std::vector<Unseen> views_;
  hal::OffscreenDisplay display_;
  std::unique_ptr<render::Renderer> renderer_;
  render::ProxyGeometry proxy_{{}, render::Estimating::AtOnce};
};

std::vector<Unseen> look(const hal::Scene& scene, const Walk& walk,
                         const std::vector<std::size_t>& indices) {
  std::vector<Unseen> views;
  for (const std::size_t index : indices) {
    const hal::StampedPose& pose = walk.poses[index];
    const render::View view{*walk.camera, pose.world_from_camera};
    views.push_back({view,
                     scene.render_ideal(view.camera, pose.world_from_camera, pose.timestamp_s),
                     render::subject_mask(view, walk.subject)});
  }
  return views;
}

}  // namespace

std::vector<RenderingVariation> rendering_variations(const config::Config& config,
                                                     const Eigen::Vector3d& focus) {
  std::vector<RenderingVariation> variations;
  for (const render::Method& method : render::compared_methods(config.render, focus)) {
    if (method.name == "plane-small" || method.name == "plane-wide" || method.name == "mesh") {
      vary(method, config.capture.threshold_deg, variations);
    }
  }
  return variations;
}

void measure_quality(
    const std::shared_ptr<const hal::Scene>& scene, const std::string& name,
    const config::Config& config, std::size_t views,
    const std::function<void(const RenderingVariation&, const QualityResult&)>& done) {
  const Walk walk = walk_of(*scene);
  const auto variations = rendering_variations(config, walk.subject.center);
  Captures captures(*scene, walk);
  std::vector<std::vector<std::size_t>> recorded;
  for (const RenderingVariation& variation : variations) {
    recorded.push_back(captures.indices(variation.threshold_deg));
  }
  const auto unseen = unseen_along(walk, recorded, views, kLeastAngle);
  if (unseen.empty()) {
    throw config::InputError("scene " + name +
                             ": no frame of its walk lies between the recorded ones with the "
                             "subject in the picture; expected a walk around its subject");
  }
  Judge judge(look(*scene, walk, unseen));
  for (const RenderingVariation& variation : variations) {
    done(variation, judge.judge(variation.method, captures.perspectives(variation.threshold_deg)));
  }
}

nlohmann::json to_json(const std::string& scene, const RenderingVariation& variation,
                       const QualityResult& result) {
  return {{"what", "rendering_quality"},
          {"scene", scene},
          {"method", variation.method.name},
          {"setting", variation.setting},
          {"value", variation.value},
          {"default", variation.is_default},
          {"perspectives", result.perspectives},
          {"views", result.views},
          {"psnr_subject", result.psnr},
          {"ssim_subject", result.ssim},
          {"ms", to_json(result.wall_ms)},
          {"cpu_ms", to_json(result.cpu_ms)}};
}

}  // namespace lumibox::bench
