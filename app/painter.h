#pragma once

#include <memory>
#include <vector>

#include "config/config.h"
#include "hal/image.h"
#include "hal/offscreen/offscreen_display.h"
#include "lightfield/perspective.h"
#include "render/light_mean.h"
#include "render/proxy_geometry.h"
#include "render/renderer.h"
#include "render/view.h"

namespace lumibox::app {

enum class Exactness {
  Fast,  ///< the GL renderer, without a screen
  Exact  ///< the reference on the CPU
};

/// Pictures of a light field for files.
class Painter {
 public:
  explicit Painter(Exactness exactness, const config::Render& options)
      : exactness_(exactness), options_(options) {}
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Three channels, size of view.camera.
  hal::Image paint(const render::View& view,
                   const std::vector<lightfield::Perspective>& perspectives,
                   const render::Settings& settings);

  /// The same through a wide aperture on the scene's shape (render::Bokeh). Where that is not
  /// possible: on planes.
  hal::Image paint_bokeh(const render::View& view,
                         const std::vector<lightfield::Perspective>& perspectives,
                         const render::Settings& settings, render::ProxyGeometry& proxy);

 private:
  void set_size(int width, int height);

  Exactness exactness_;
  config::Render options_;
  std::unique_ptr<hal::OffscreenDisplay> display_;
  std::unique_ptr<render::Renderer> renderer_;  ///< lives in the display's context
  std::unique_ptr<render::LightMean> mean_;     ///< likewise
};

}  // namespace lumibox::app
