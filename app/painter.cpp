#include "app/painter.h"

#include "render/bokeh.h"
#include "render/reference.h"

namespace lumibox::app {

Painter::~Painter() {
  if (display_) {
    display_->make_current();
  }
}

hal::Image Painter::paint(const render::View& view,
                          const std::vector<lightfield::Perspective>& perspectives,
                          const render::Settings& settings) {
  if (exactness_ == Exactness::Exact) {
    return render::render_reference(view, perspectives, settings);
  }
  set_size(view.camera.width(), view.camera.height());
  renderer_->draw(view, perspectives, settings, display_->framebuffer());
  return display_->read_back();
}

hal::Image Painter::paint_bokeh(const render::View& view,
                                const std::vector<lightfield::Perspective>& perspectives,
                                const render::Settings& settings, render::ProxyGeometry& proxy) {
  if (exactness_ == Exactness::Exact) {
    const auto picture = render::render_bokeh_reference(view, perspectives, settings, proxy);
    return picture ? *picture : paint(view, perspectives, settings);
  }
  set_size(view.camera.width(), view.camera.height());
  render::Bokeh bokeh(view, perspectives, settings);
  while (bokeh.prepare(proxy) && bokeh.is_possible() && !bokeh.is_complete()) {
    bokeh.draw(*renderer_, *mean_, view.camera.height());
  }
  if (!bokeh.is_complete()) {
    return paint(view, perspectives, settings);
  }
  mean_->draw(display_->framebuffer());
  return display_->read_back();
}

void Painter::set_size(int width, int height) {
  if (display_ && display_->width() == width && display_->height() == height) {
    display_->make_current();
    return;
  }
  mean_.reset();
  renderer_.reset();
  display_ = std::make_unique<hal::OffscreenDisplay>(width, height);
  display_->make_current();
  renderer_ = std::make_unique<render::Renderer>(options_);
  mean_ = std::make_unique<render::LightMean>();
}

}  // namespace lumibox::app
