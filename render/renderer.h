#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "config/config.h"
#include "lightfield/perspective.h"
#include "render/read_ahead.h"
#include "render/view.h"

namespace lumibox::render {

/// Rows of a framebuffer, counted from the bottom as GL does.
struct Rows {
  int first = 0;
  int count = 0;
};

/// The light field renderer on OpenGL ES 3: all layers of a pixel in one shader, from a texture
/// array, with a homography per layer. All calls need the same current context, the destructor
/// included. A GPU that cannot hold the pictures or compile the shaders throws config::InputError.
class Renderer {
 public:
  /// With somebody who reads `ahead`, who must outlive this, no draw waits for more than a handful
  /// of files; without, all pictures of a view are there at once.
  explicit Renderer(const config::Render& options = {}, ReadAhead* ahead = nullptr);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws the view into `framebuffer`, which has the size of view.camera; every pixel is written.
  /// Pictures not yet on the GPU are uploaded first, or if they are read ahead as they come: until
  /// then the next nearest take their place, and it says false. Those that are lost are left out.
  /// With `rows` only those are written.
  bool draw(const View& view, const std::vector<lightfield::Perspective>& perspectives,
            const Settings& settings, unsigned framebuffer,
            std::optional<Rows> rows = std::nullopt);

  /// Uploads one picture ahead of its first use, so that the tick that reviews does not pay for it.
  void upload(const lightfield::Perspective& perspective);

  /// Has the driver translate the next of the shaders that views like this, from anywhere, of
  /// pictures of `source` can need, or the first of them would wait for it. Drivers do that when
  /// they first draw, so this draws into `framebuffer`: what was in it is lost. False, and nothing
  /// is drawn, if there is none left.
  bool prepare_next(const View& view, const std::shared_ptr<const geometry::Camera>& source,
                    unsigned framebuffer);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::render
