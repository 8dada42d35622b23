#include "render/leave_one_out.h"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "render/image_quality.h"
#include "render/sampling.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

/// The weight of a perspective at half the limit's angle is a millionth.
constexpr double kSharpExponent = 20.0;

hal::Image both(hal::Image a, const hal::Image& b) {
  for (std::size_t i = 0; i < a.size_bytes(); ++i) a.data()[i] &= b.data()[i];
  return a;
}

/// Mean of one field over the views where it is a number.
double mean_of(const std::vector<ViewQuality>& views, double Quality::*field) {
  double sum = 0.0;
  double count = 0.0;
  for (const ViewQuality& view : views) {
    const double value = view.quality.*field;
    if (std::isnan(value)) continue;
    sum += value;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

Quality mean_of(const std::vector<ViewQuality>& views) {
  return {mean_of(views, &Quality::psnr), mean_of(views, &Quality::ssim),
          mean_of(views, &Quality::psnr_subject), mean_of(views, &Quality::ssim_subject)};
}

}  // namespace

std::vector<Method> compared_methods(const config::Render& options, const Eigen::Vector3d& focus) {
  Settings nearest = settings_from(options, Aperture::Small, focus);
  nearest.k = 1;
  const Settings wide = settings_from(options, Aperture::Wide, focus);
  Settings sharp = wide;
  sharp.exponent = kSharpExponent;
  const Settings small = settings_from(options, Aperture::Small, focus);
  return {{"nearest", nearest},
          {"plane-small", small},
          {"plane-wide", wide},
          {"plane-sharp", sharp},
          {"focal", small, Geometry::Focal},
          {"mesh", small, Geometry::Mesh}};
}

UndistortedPicture undistort(const Perspective& perspective) {
  const geometry::Camera& camera = *perspective.camera;
  const geometry::Camera pinhole = camera.undistorted();
  const std::shared_ptr<const hal::Image> from = perspective.photo->require_rgb();
  UndistortedPicture result{hal::Image(pinhole.width(), pinhole.height(), 3),
                            hal::Image(pinhole.width(), pinhole.height(), 1)};
  for (int y = 0; y < pinhole.height(); ++y) {
    for (int x = 0; x < pinhole.width(); ++x) {
      const Eigen::Vector3d ray = pinhole.unproject(Eigen::Vector2d(x, y))->homogeneous();
      const auto pixel = camera.project(ray);
      if (!pixel || !camera.contains(*pixel)) continue;
      const Eigen::Vector3d color = sample_bilinear(*from, *pixel);
      for (int c = 0; c < 3; ++c) {
        result.color.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(color[c]));
      }
      *result.valid.at(x, y) = 255;
    }
  }
  return result;
}

Photograph photograph_of(const Perspective& perspective, const lightfield::Sphere& subject) {
  const View view{perspective.camera->undistorted(), perspective.world_from_camera};
  UndistortedPicture picture = undistort(perspective);
  hal::Image on_subject = both(subject_mask(view, subject), picture.valid);
  return {view, std::move(picture), std::move(on_subject)};
}

Quality quality_of(const hal::Image& picture, const Photograph& photograph) {
  const UndistortedPicture& truth = photograph.picture;
  return {psnr(picture, truth.color, &truth.valid), ssim(picture, truth.color, &truth.valid),
          psnr(picture, truth.color, &photograph.on_subject),
          ssim(picture, truth.color, &photograph.on_subject)};
}

std::vector<MethodQuality> leave_one_out(const std::vector<Perspective>& perspectives,
                                         const lightfield::Sphere& subject,
                                         const config::Render& options, const RenderView& render,
                                         const std::function<void(std::size_t)>& each_view) {
  const std::vector<Method> compared = compared_methods(options, subject.center);
  std::vector<MethodQuality> results;
  for (const Method& method : compared) results.push_back({method.name, {}, {}});

  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    if (each_view) each_view(i);
    const Perspective& left_out = perspectives[i];
    std::vector<Perspective> others = perspectives;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));

    const Photograph photograph = photograph_of(left_out, subject);
    for (std::size_t m = 0; m < compared.size(); ++m) {
      const hal::Image picture = render(photograph.view, others, compared[m]);
      results[m].views.push_back({left_out.id, left_out.file, quality_of(picture, photograph)});
    }
  }
  for (MethodQuality& result : results) result.mean = mean_of(result.views);
  return results;
}

}  // namespace lumibox::render
