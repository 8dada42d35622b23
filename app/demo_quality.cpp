#include "app/demo_quality.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "app/painter.h"
#include "bench/trajectory.h"
#include "render/image_quality.h"
#include "render/leave_one_out.h"

namespace lumibox::app {
namespace {

constexpr std::size_t kViews = 8;

double mean_distance(const std::vector<hal::StampedPose>& poses, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (const hal::StampedPose& pose : poses) {
    sum += (pose.world_from_camera.translation - point).norm();
  }
  return sum / static_cast<double>(poses.size());
}

/// A view that nobody recorded, and what the simulator sees there.
struct Compared {
  render::View view;
  hal::Image actual;
  hal::Image subject;  ///< 255 where the picture shows it
};

void say_likeness(const render::Method& method, const std::vector<Compared>& views,
                  const std::vector<lightfield::Perspective>& perspectives,
                  render::ProxyGeometry& proxy, Painter& painter) {
  double worst = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Compared& compared : views) {
    const hal::Image rendered =
        painter.paint(compared.view, perspectives,
                      proxy.fit(method.settings, method.geometry, compared.view, perspectives));
    const double psnr = render::psnr(rendered, compared.actual, &compared.subject);
    worst = std::min(worst, psnr);
    sum += psnr;
  }
  std::printf("  %-12s %.1f dB (worst %.1f)\n", method.name.c_str(),
              sum / static_cast<double>(views.size()), worst);
}

}  // namespace

void say_quality(const hal::Scene& scene, const Loop& loop) {
  const auto& light_field = loop.recorder().light_field();
  const auto& perspectives = light_field.perspectives();
  const LoopStatistics statistics = loop.statistics();
  std::printf("%lld of %lld frames tracked, %zu perspectives recorded\n",
              static_cast<long long>(statistics.tracked), static_cast<long long>(statistics.frames),
              perspectives.size());

  std::vector<hal::StampedPose> estimate;
  std::vector<hal::StampedPose> truth;
  for (const auto& perspective : perspectives) {
    const double time_s = 1e-9 * static_cast<double>(perspective.timestamp_ns);
    estimate.push_back({time_s, perspective.world_from_camera});
    truth.push_back({time_s, scene.world_from_camera(time_s)});
  }
  const auto error = bench::compare_trajectories(estimate, truth);
  if (!error) {
    return;
  }
  std::printf("their positions are off by %.2f %% of the distance to the subject (RMSE)\n",
              100.0 * error->rmse / mean_distance(truth, scene.subject().center));

  const geometry::Camera camera = geometry::Camera(scene.profile()).undistorted();
  const geometry::Similarity estimate_from_truth = error->truth_from_estimate.inverse();
  std::vector<Compared> views;
  for (std::size_t i = 0; i < kViews; ++i) {
    const std::size_t before = (2 * i + 1) * (truth.size() - 1) / (2 * kViews);
    const double time_s = 0.5 * (truth[before].timestamp_s + truth[before + 1].timestamp_s);
    const geometry::Pose pose = scene.world_from_camera(time_s);
    views.push_back({{camera, estimate_from_truth * pose},
                     scene.render_ideal(camera, pose, time_s),
                     scene.subject_mask(camera, pose, time_s)});
  }
  std::printf("%zu views between them, against the simulator's own, on the subject:\n", kViews);
  Painter painter(Exactness::Fast, loop.config().render);
  render::ProxyGeometry proxy(loop.moment().map.points(), render::Estimating::AtOnce);
  for (const render::Method& method :
       render::compared_methods(loop.config().render, light_field.subject()->center)) {
    say_likeness(method, views, perspectives, proxy, painter);
  }
}

}  // namespace lumibox::app
