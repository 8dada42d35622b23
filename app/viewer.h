#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/picture.h"
#include "config/config.h"
#include "hal/clock.h"
#include "render/bokeh.h"
#include "render/canvas.h"
#include "render/governor.h"
#include "render/read_ahead.h"
#include "render/renderer.h"

namespace lumibox::app {

/// Shows light fields on a framebuffer in the time there is. A view that moves is drawn with the
/// effort that render::Governor allows; one that rests is refined to full quality in a canvas, some
/// rows in each tick so that none is late, and shown when it is complete; after it, with a wide
/// aperture on the scene's shape, a render::Bokeh. On a virtual clock nothing takes time, and
/// everything but the bokeh, of which each tick draws a view, is at full quality at once. All calls
/// need the same current context, the destructor included.
class Viewer {
 public:
  Viewer(const hal::Clock& clock, const config::Render& options, render::Estimating estimating);

  /// Before anything is drawn: makes what lives in the context that is current.
  void begin_drawing();

  /// Has the next of the shaders compiled that views of pictures taken by `live` will need, and
  /// draws into `framebuffer` to that end, until there are all.
  void prepare_next(const render::View& view, const std::shared_ptr<const geometry::Camera>& live,
                    unsigned framebuffer);

  /// Ends what lives in the context; what was learned stays.
  void end_drawing();

  /// Draws `shown` from `view`, of the size of `framebuffer`, within `budget_ms` if that can be
  /// done.
  void draw(const LightFieldPicture& shown, const render::View& view, unsigned framebuffer,
            double budget_ms);

  /// Uploads one picture ahead of its first use.
  void upload(const lightfield::Perspective& perspective) { gl_->renderer.upload(perspective); }

  /// What the last view was drawn with and what that took, for the screen's figures.
  const std::string& figures() const { return figures_; }

 private:
  /// All that lives in the display's context.
  struct Gl {
    Gl(const config::Render& options, render::ReadAhead* ahead) : renderer(options, ahead) {}

    render::Renderer renderer;
    bool prepared = false;
    render::Canvas moving;  ///< the last view that moved, if it was drawn small
    render::Canvas refined;
    render::LightMean mean;
  };
  /// A view that has not moved by a pixel since it was first seen.
  struct Rest {
    render::View view;
    LightFieldPicture shown;
    int ticks = 0;
  };
  /// The refined view, as far as it has been drawn.
  struct Refinement {
    render::Settings settings;
    int rows = 0;           ///< from the bottom
    bool complete = false;  ///< once; what is drawn again goes over it
    int ticks = 0;          ///< since it was complete last
  };

  void follow(const LightFieldPicture& shown, const render::View& view);
  void draw_moving(const LightFieldPicture& shown, const render::View& view, unsigned framebuffer,
                   double budget_ms);
  void refine(double budget_ms);
  void begin_refinement();
  void refine_planes(double budget_ms);
  void refine_bokeh(double budget_ms);
  void fit_rows(int rows, double ms, double budget_ms);
  double measure_ms(std::int64_t since_ns) const;
  void note(const render::Effort& effort, const LightFieldPicture& shown);

  const hal::Clock& clock_;
  config::Render options_;
  render::ProxyGeometry proxy_;
  render::Governor governor_;
  render::Effort effort_;  ///< of the last view that moved
  std::optional<Rest> rest_;
  std::optional<Refinement> refinement_;
  std::optional<render::Bokeh> bokeh_;  ///< of the refined view
  int rows_per_tick_ = 0;
  std::string figures_;
  std::unique_ptr<render::ReadAheadThread> reader_;  ///< null: pictures are read at once
  std::optional<Gl> gl_;
};

/// How far things at the focus and at infinity move in the picture from one view to another,
/// pixels, about.
double motion_px(const render::View& from, const render::View& to, const Eigen::Vector3d& focus);

}  // namespace lumibox::app
