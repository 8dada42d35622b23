#include <fmt/core.h>

#include <optional>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "app/painter.h"
#include "app/progress.h"
#include "config/error.h"
#include "hal/image_io.h"
#include "hal/replay/sequence.h"
#include "lightfield/capture.h"
#include "render/proxy_geometry.h"

namespace lumibox::app {
namespace {

render::Settings settings_of(const RenderOptions& options, config::Render render,
                             const lightfield::Sphere& subject) {
  render.k = options.k.value_or(render.k);
  render.exponent = options.exponent.value_or(render.exponent);
  const auto aperture = options.mode == "wide" ? render::Aperture::Wide : render::Aperture::Small;
  return render::settings_from(render, aperture, subject.center);
}

/// The small aperture shows what the configuration says, the wide one the recorded pictures.
render::Geometry geometry_of(const RenderOptions& options, const config::Render& render) {
  const std::string usual = options.mode == "wide" ? "plane" : render.geometry;
  return render::geometry_named(options.geometry.value_or(usual));
}

}  // namespace

void render_views(const RenderOptions& options) {
  const config::Render config = load_config(options.sources).render;
  refuse_recorded(options.out, options.capture);
  const lightfield::Capture capture = lightfield::load_capture(options.capture);
  const auto& perspectives = capture.light_field.perspectives();
  if (perspectives.empty()) {
    throw config::InputError(options.capture, "holds no perspectives to render from");
  }
  const render::Settings settings = settings_of(options, config, subject_of(capture));
  const auto views = hal::read_tum_trajectory(options.views);
  if (views.empty()) {
    throw config::InputError(options.views,
                             "holds no poses; expected lines `t tx ty tz qx qy qz qw`");
  }
  const geometry::Camera camera =
      options.calibration ? geometry::Camera(hal::read_calibration(*options.calibration))
                          : *perspectives.front().camera;
  const render::Geometry geometry = geometry_of(options, config);
  const bool bokeh =
      settings.aperture == render::Aperture::Wide && geometry == render::Geometry::Mesh;
  render::ProxyGeometry proxy(capture.points, render::Estimating::AtOnce);
  Painter painter(options.reference ? Exactness::Exact : Exactness::Fast, config);
  make_folder(options.out);
  Progress progress("rendering", static_cast<std::int64_t>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const render::View view{camera.undistorted(), views[i].world_from_camera};
    const hal::Image picture =
        bokeh
            ? painter.paint_bokeh(view, perspectives, settings, proxy)
            : painter.paint(view, perspectives, proxy.fit(settings, geometry, view, perspectives));
    hal::write_png(options.out / fmt::format("{:06}.png", i), picture);
    progress.show(static_cast<std::int64_t>(i + 1));
  }
  require_all_pictures(capture);
}

}  // namespace lumibox::app
