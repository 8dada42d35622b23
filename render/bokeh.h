#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hal/image.h"
#include "lightfield/perspective.h"
#include "render/light_mean.h"
#include "render/proxy_geometry.h"
#include "render/renderer.h"
#include "render/view.h"

namespace lumibox::render {

/// A view through the wide aperture on the scene's shape: the mean, of light, of the views from
/// all over it (aperture_views), so that what is out of focus is a smooth disc, where the recorded
/// pictures alone show it once each. It is drawn bit by bit; `Renderer`, `ProxyGeometry` and
/// `LightMean` must be the same in all calls, and nobody else may use the latter.
class Bokeh {
 public:
  Bokeh(const View& view, std::vector<lightfield::Perspective> perspectives,
        const Settings& settings);

  /// False if there is nothing to draw: `settings.aperture_views` is 0, S lies behind the view, or
  /// nothing is known of the shape.
  bool is_possible() const { return !views_.empty(); }
  bool is_complete() const { return is_possible() && next_ == views_.size(); }

  /// Makes the next rows ready to be drawn. False if depth maps that they need are still to come.
  bool prepare(ProxyGeometry& proxy);

  /// Draws some more rows, of one view at the most, and says how many. A view of which pictures are
  /// still to come is begun again: what is in the mean stays there. Precondition: prepare() was
  /// true and the bokeh is possible and not complete.
  int draw(Renderer& renderer, LightMean& mean, int rows);

  std::size_t views() const { return views_.size(); }
  std::size_t drawn() const { return next_; }  ///< views

 private:
  std::vector<lightfield::Perspective> perspectives_;
  Settings settings_;
  std::vector<View> views_;
  std::size_t next_ = 0;
  std::optional<Settings> fitted_;  ///< to that view
  int row_ = 0;                     ///< of it
};

/// The same on the CPU, all at once; none if it is not possible.
std::optional<hal::Image> render_bokeh_reference(
    const View& view, const std::vector<lightfield::Perspective>& perspectives,
    const Settings& settings, ProxyGeometry& proxy);

}  // namespace lumibox::render
