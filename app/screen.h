#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/picture.h"
#include "app/viewer.h"
#include "config/config.h"
#include "geometry/camera.h"
#include "hal/display.h"
#include "hal/frame.h"
#include "render/overlay.h"

namespace lumibox::app {

/// Puts what the modes want to show on the display. The display's context must be current in every
/// call, the destructor included.
class Screen {
 public:
  /// `live` is the camera whose pictures are shown; they fill the display as far as their shape
  /// allows.
  Screen(hal::Display& display, const hal::Clock& clock, const geometry::Camera& live,
         const config::Render& options, render::Estimating estimating);

  /// Draws without presenting. `frame` is the newest one; its picture may be null. A light field is
  /// drawn as well as it can be by `deadline_ns` of the clock.
  void draw(const Picture& picture, const hal::Frame& frame, std::int64_t deadline_ns);

  /// How the last light field was drawn.
  const std::string& viewer_figures() const { return viewer_.figures(); }

  /// Presents what was drawn. If the display has lost its context, a new one is made and all that
  /// was in the old; the next picture drawn is as it would have been.
  void present();

  /// Hands a recorded picture to the GPU now, so that the tick that reviews does not pay for it.
  void upload(const lightfield::Perspective& perspective) { viewer_.upload(perspective); }

 private:
  void begin_drawing();
  void draw_backdrop(const Picture& picture, const hal::Frame& frame, const render::View& view,
                     std::int64_t deadline_ns);
  void draw_text(const Picture& picture);

  hal::Display& display_;
  const hal::Clock& clock_;
  std::shared_ptr<const geometry::Camera> live_;
  geometry::Camera view_camera_;  ///< without distortion, of the display's size
  Viewer viewer_;
  bool first_picture_ = true;  ///< of this context
  std::optional<render::Overlay> overlay_;  ///< none only while a context is made again
};

/// The pinhole camera that shows the whole picture of `camera`, undistorted and as large as
/// possible, in the middle of a picture of the given size.
geometry::Camera fitted_camera(const geometry::Camera& camera, int width, int height);

/// What a picture says, on a display of the given size: the title and below it the details
/// and the alerts, the advice at the bottom, each wrapped to the width; only the title is always
/// one line.
std::vector<render::Text> text_of(const Picture& picture, int width, int height);

/// The text in lines of at most `letters` letters, broken between words, or within one that is
/// longer than a line, as a path may be. Precondition: letters > 0.
std::vector<std::string> wrapped(const std::string& text, std::size_t letters);

}  // namespace lumibox::app
