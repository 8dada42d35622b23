#include "app/demo_quality.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "app/painter.h"
#include "app/trajectory.h"
#include "render/image_quality.h"

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
  const auto error = compare_trajectories(estimate, truth);
  if (!error) {
    return;
  }
  std::printf("their positions are off by %.2f %% of the distance to the subject (RMSE)\n",
              100.0 * error->rmse / mean_distance(truth, scene.subject().center));

  const geometry::Camera camera = geometry::Camera(scene.profile()).undistorted();
  const geometry::Similarity estimate_from_truth = error->truth_from_estimate.inverse();
  const render::Settings settings = render::settings_from(
      loop.config().render, render::Aperture::Small, light_field.subject()->center);
  Painter painter(Exactness::Fast);
  double worst = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < kViews; ++i) {
    const std::size_t before = (2 * i + 1) * (truth.size() - 1) / (2 * kViews);
    const double time_s = 0.5 * (truth[before].timestamp_s + truth[before + 1].timestamp_s);
    const render::View true_view{camera, scene.world_from_camera(time_s)};
    const render::View view{camera, estimate_from_truth * true_view.world_from_camera};
    const hal::Image rendered = painter.paint(view, perspectives, settings);
    const hal::Image actual = scene.render_ideal(camera, true_view.world_from_camera, time_s);
    const hal::Image mask = scene.subject_mask(camera, true_view.world_from_camera, time_s);
    const double psnr = render::psnr(rendered, actual, &mask);
    worst = std::min(worst, psnr);
    sum += psnr;
  }
  std::printf(
      "%zu views between them, against the simulator's own: %.1f dB on the subject "
      "(worst %.1f dB)\n",
      kViews, sum / static_cast<double>(kViews), worst);
}

}  // namespace lumibox::app
