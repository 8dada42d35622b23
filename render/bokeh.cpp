#include "render/bokeh.h"

#include <algorithm>
#include <utility>

#include "render/aperture_views.h"
#include "render/reference.h"

namespace lumibox::render {

using lightfield::Perspective;

Bokeh::Bokeh(const View& view, std::vector<Perspective> perspectives, const Settings& settings)
    : perspectives_(std::move(perspectives)),
      settings_(settings),
      views_(aperture_views(view, perspectives_, settings)) {}

bool Bokeh::prepare(ProxyGeometry& proxy) {
  if (fitted_ || !is_possible() || is_complete()) return true;
  Settings fitted = proxy.fit(settings_, Geometry::Mesh, views_[next_], perspectives_);
  if (!proxy.is_complete()) return false;
  if (!fitted.shape) views_.clear();
  fitted_ = std::move(fitted);
  return true;
}

int Bokeh::draw(Renderer& renderer, LightMean& mean, int rows) {
  const View& view = views_[next_];
  const int height = view.camera.height();
  if (next_ == 0 && row_ == 0) mean.begin(view.camera.width(), height);
  rows = std::min(rows, height - row_);
  const bool whole =
      renderer.draw(view, perspectives_, *fitted_, mean.framebuffer(), Rows{row_, rows});
  row_ = whole ? row_ + rows : 0;
  if (row_ == height) {
    mean.add();
    fitted_.reset();
    row_ = 0;
    ++next_;
  }
  return rows;
}

std::optional<hal::Image> render_bokeh_reference(const View& view,
                                                 const std::vector<Perspective>& perspectives,
                                                 const Settings& settings, ProxyGeometry& proxy) {
  const int width = view.camera.width();
  const int height = view.camera.height();
  std::vector<CoveredLight> mean(static_cast<std::size_t>(width * height));
  const std::vector<View> views = aperture_views(view, perspectives, settings);
  const double share = 1.0 / static_cast<double>(views.size());
  for (const View& one : views) {
    const Settings fitted = proxy.fit(settings, Geometry::Mesh, one, perspectives);
    if (!fitted.shape) return std::nullopt;
    const std::vector<CoveredLight> seen = reference_light(one, perspectives, fitted);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i].light += share * seen[i].light;
      mean[i].covered += share * seen[i].covered;
    }
  }
  if (views.empty()) return std::nullopt;
  for (CoveredLight& pixel : mean) {
    pixel.light /= std::max(pixel.covered, LightMean::kLeastCover);
  }
  return stored_picture(mean, width, height);
}

}  // namespace lumibox::render
