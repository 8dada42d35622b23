#include "app/viewer.h"

#include <GLES3/gl3.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "config/log.h"

namespace lumibox::app {
namespace {

using lightfield::Perspective;

constexpr double kStill = 1.0;      // pixels: less is the trembling of a hand at rest
constexpr int kTicksToRest = 5;     // a view may stand still in passing
constexpr int kLeastRows = 8;       // of a refined view in one tick
constexpr int kFirstBands = 8;      // until it is known how long a row takes
constexpr double kBandShare = 0.8;  // of the budget
constexpr int kTicksToRefineAgain = 30;
constexpr double kLeastShare = 0.5;  // of the budget; with less left no rows are drawn

bool same_perspective(const Perspective& a, const Perspective& b) {
  return a.id == b.id && a.photo == b.photo && a.gain == b.gain &&
         a.world_from_camera.translation == b.world_from_camera.translation &&
         a.world_from_camera.rotation.coeffs() == b.world_from_camera.rotation.coeffs();
}

/// True if both show the same from the same view.
bool same_picture(const LightFieldPicture& a, const LightFieldPicture& b) {
  return a.geometry == b.geometry && a.settings.aperture == b.settings.aperture &&
         a.settings.k == b.settings.k && a.settings.exponent == b.settings.exponent &&
         a.settings.focus == b.settings.focus &&
         std::ranges::equal(a.perspectives, b.perspectives, same_perspective);
}

/// True if at rest it is to be more than pictures on planes.
bool has_bokeh(const LightFieldPicture& shown) {
  return shown.geometry == render::Geometry::Mesh &&
         shown.settings.aperture == render::Aperture::Wide && shown.settings.aperture_views > 0;
}

render::View scaled(const render::View& view, double scale) {
  config::CameraProfile c = view.camera.profile();
  const int width = std::max(1, static_cast<int>(std::lround(scale * c.width)));
  const int height = std::max(1, static_cast<int>(std::lround(scale * c.height)));
  const double across = static_cast<double>(width) / c.width;
  const double down = static_cast<double>(height) / c.height;
  c.fx *= across;
  c.fy *= down;
  c.cx = across * (c.cx + 0.5) - 0.5;  // pixel centres are at integers
  c.cy = down * (c.cy + 0.5) - 0.5;
  c.width = width;
  c.height = height;
  return {geometry::Camera(c), view.world_from_camera};
}

}  // namespace

double motion_px(const render::View& from, const render::View& to, const Eigen::Vector3d& focus) {
  const double f = to.camera.profile().fx;
  const double distance = (focus - to.world_from_camera.translation).norm();
  const double turned =
      from.world_from_camera.rotation.angularDistance(to.world_from_camera.rotation);
  const double moved =
      (from.world_from_camera.translation - to.world_from_camera.translation).norm();
  return f * (turned + moved / std::max(distance, 1e-9));
}

Viewer::Viewer(const hal::Clock& clock, const config::Render& options,
               render::Estimating estimating)
    : clock_(clock), options_(options), proxy_({}, estimating) {
  if (estimating == render::Estimating::Meanwhile) {
    reader_ = std::make_unique<render::ReadAheadThread>();
  }
}

void Viewer::begin_drawing() {
  gl_.emplace(options_, reader_ ? &reader_->pictures() : nullptr);
}

void Viewer::prepare_next(const render::View& view,
                          const std::shared_ptr<const geometry::Camera>& live,
                          unsigned framebuffer) {
  if (gl_->prepared || gl_->renderer.prepare_next(view, live, framebuffer)) return;
  // The first enlargement would have its tick wait for the driver's compiler, as would a shader.
  gl_->moving.set_size(view.camera.width() / 2, view.camera.height() / 2);
  gl_->moving.show(framebuffer, view.camera.width(), view.camera.height());
  gl_->prepared = true;
}

void Viewer::end_drawing() {
  gl_.reset();
  rest_.reset();
  refinement_.reset();
  bokeh_.reset();
}

void Viewer::draw(const LightFieldPicture& shown, const render::View& view, unsigned framebuffer,
                  double budget_ms) {
  follow(shown, view);
  const bool can_be_better = effort_.scale < 1.0 || has_bokeh(shown);
  if (rest_->ticks <= kTicksToRest || !can_be_better) {
    draw_moving(shown, view, framebuffer, budget_ms);
    return;
  }
  refine(budget_ms);
  const render::Canvas& canvas = refinement_->complete ? gl_->refined : gl_->moving;
  canvas.show(framebuffer, view.camera.width(), view.camera.height());
}

/// Whether the view rests.
void Viewer::follow(const LightFieldPicture& shown, const render::View& view) {
  if (rest_ && same_picture(rest_->shown, shown) &&
      motion_px(rest_->view, view, shown.settings.focus) < kStill) {
    ++rest_->ticks;
    return;
  }
  rest_ = Rest{view, shown, 0};
  refinement_.reset();
  bokeh_.reset();
}

void Viewer::draw_moving(const LightFieldPicture& shown, const render::View& view,
                         unsigned framebuffer, double budget_ms) {
  const std::int64_t begin_ns = clock_.now_ns();
  const render::Effort effort =
      governor_.choose({shown.geometry, shown.settings.aperture}, budget_ms);
  const render::View drawn = scaled(view, effort.scale);
  const render::Settings settings = proxy_.fit(render::at_effort(shown.settings, effort),
                                               effort.geometry, drawn, shown.perspectives);
  if (effort.scale < 1.0) {
    gl_->moving.set_size(drawn.camera.width(), drawn.camera.height());
    gl_->renderer.draw(drawn, shown.perspectives, settings, gl_->moving.framebuffer());
    gl_->moving.show(framebuffer, view.camera.width(), view.camera.height());
  } else {
    gl_->renderer.draw(drawn, shown.perspectives, settings, framebuffer);
  }
  glFinish();  // what it takes is to be known; the next tick needs the GPU no sooner
  governor_.measured(measure_ms(begin_ns));
  note(effort, shown);
}

/// Draws some more of the view that rests: what it is projected onto, then row by row, then what is
/// better still. On its own it begins again now and then, as depth maps may have come.
void Viewer::refine(double budget_ms) {
  const bool drawn = refinement_ && refinement_->rows == rest_->view.camera.height();
  if (drawn && bokeh_ && bokeh_->is_possible()) {
    if (!bokeh_->is_complete()) refine_bokeh(budget_ms);
  } else if (!refinement_ || (drawn && ++refinement_->ticks >= kTicksToRefineAgain)) {
    begin_refinement();
    // Without a smaller picture to go on showing it is drawn at once, as when it moved.
    if (effort_.scale == 1.0 && !refinement_->complete) refine_planes(budget_ms);
  } else if (!drawn) {
    refine_planes(budget_ms);
  }
}

void Viewer::begin_refinement() {
  const auto& [view, shown, ticks] = *rest_;
  const int height = view.camera.height();
  const bool again = refinement_.has_value();
  gl_->refined.set_size(view.camera.width(), height);
  const render::Geometry geometry = has_bokeh(shown) ? render::Geometry::Plane : shown.geometry;
  refinement_ =
      Refinement{proxy_.fit(shown.settings, geometry, view, shown.perspectives), 0, again, 0};
  if (has_bokeh(shown)) bokeh_.emplace(view, shown.perspectives, shown.settings);
  if (again) return;
  rows_per_tick_ = effort_.scale == 1.0 ? height : std::max(kLeastRows, height / kFirstBands);
}

void Viewer::refine_planes(double budget_ms) {
  const auto& [view, shown, ticks] = *rest_;
  const int height = view.camera.height();
  const std::int64_t begin_ns = clock_.now_ns();
  const int rows = std::min(rows_per_tick_, height - refinement_->rows);
  gl_->renderer.draw(view, shown.perspectives, refinement_->settings, gl_->refined.framebuffer(),
                     render::Rows{refinement_->rows, rows});
  glFinish();
  refinement_->rows += rows;
  refinement_->complete = refinement_->complete || refinement_->rows == height;
  fit_rows(rows, measure_ms(begin_ns), budget_ms);
  figures_ = fmt::format("at rest, {} of {} rows refined", refinement_->rows, height);
}

/// Either what the next view is projected onto, or some of its rows: both take their time.
void Viewer::refine_bokeh(double budget_ms) {
  const std::int64_t begin_ns = clock_.now_ns();
  if (!bokeh_->prepare(proxy_) || !bokeh_->is_possible()) return;
  const double left_ms = budget_ms - measure_ms(begin_ns);
  if (left_ms < kLeastShare * budget_ms) return;
  const std::int64_t prepared_ns = clock_.now_ns();
  const int rows = bokeh_->draw(gl_->renderer, gl_->mean, rows_per_tick_);
  glFinish();
  fit_rows(rows, measure_ms(prepared_ns), budget_ms);
  if (bokeh_->is_complete()) gl_->mean.draw(gl_->refined.framebuffer());
  figures_ =
      fmt::format("at rest, {} of {} views of the aperture", bokeh_->drawn(), bokeh_->views());
}

/// As many rows in the next tick as fit, given how long some took.
void Viewer::fit_rows(int rows, double ms, double budget_ms) {
  const int height = rest_->view.camera.height();
  const double fitting = ms > 0.0 ? rows * kBandShare * budget_ms / ms : height;
  rows_per_tick_ = std::clamp(static_cast<int>(fitting), kLeastRows, height);
}

double Viewer::measure_ms(std::int64_t since_ns) const {
  return 1e-6 * static_cast<double>(clock_.now_ns() - since_ns);
}

void Viewer::note(const render::Effort& effort, const LightFieldPicture& shown) {
  const std::string chosen = render::description(effort, shown.settings.k);
  if (effort != effort_) config::log_info("review is drawn with " + chosen);
  effort_ = effort;
  figures_ = fmt::format("{}; {:.1f} of {:.1f} ms", chosen, governor_.expected_ms(),
                         governor_.budget_ms());
}

}  // namespace lumibox::app
