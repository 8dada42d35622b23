#include "app/screen.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <vector>

#include "config/log.h"
#include "render/gl.h"

namespace lumibox::app {
namespace {

/// Of the time to the deadline: what lies over the picture needs some too, and no two ticks are
/// alike.
constexpr double kBudgetShare = 0.8;

constexpr render::Color kWhite{1.0F, 1.0F, 1.0F, 1.0F};
constexpr render::Color kYellow{1.0F, 0.85F, 0.2F, 1.0F};
constexpr render::Color kGrey{0.75F, 0.8F, 0.85F, 1.0F};
constexpr render::Color kRed{1.0F, 0.35F, 0.3F, 1.0F};
constexpr float kSmallest = 12.0F;    // pixels; smaller letters are not read at arm's length
constexpr float kLetterWidth = 0.6F;  // of the size: more than the mean of any sentence

}  // namespace

Screen::Screen(hal::Display& display, const hal::Clock& clock, const geometry::Camera& live,
               const config::Render& options, render::Estimating estimating)
    : display_(display),
      clock_(clock),
      live_(std::make_shared<const geometry::Camera>(live)),
      view_camera_(fitted_camera(live, display.width(), display.height())),
      viewer_(clock, options, estimating) {
  begin_drawing();
}

void Screen::begin_drawing() {
  overlay_.emplace();
  viewer_.begin_drawing();
  first_picture_ = true;
}

void Screen::present() {
  display_.present();
  if (!display_.lost()) {
    return;
  }
  config::log_warning("the display has lost its context: everything in it is made again");
  overlay_.reset();  // while the lost context is current, in which no name means anything
  viewer_.end_drawing();
  display_.renew();
  begin_drawing();
}

void Screen::draw(const Picture& picture, const hal::Frame& frame, std::int64_t deadline_ns) {
  const render::View view{view_camera_, picture.world_from_view.value_or(geometry::Pose{})};
  // One shader with each picture, so that the first one is on the screen soon; not while a light
  // field is shown, which has what it needs compiled by itself.
  if (!first_picture_ && !picture.light_field) {
    viewer_.prepare_next({view_camera_, geometry::Pose{}}, live_, display_.framebuffer());
  }
  first_picture_ = false;
  draw_backdrop(picture, frame, view, deadline_ns);
  const unsigned framebuffer = display_.framebuffer();
  if (picture.coverage) {
    overlay_->draw_coverage(*picture.coverage, view, framebuffer);
  }
  if (picture.way) {
    overlay_->draw_arrow(*picture.way, display_.width(), display_.height(), framebuffer);
  }
  if (picture.reticle) {
    overlay_->draw_reticle(display_.width(), display_.height(), framebuffer);
  }
  draw_text(picture);
}

void Screen::draw_backdrop(const Picture& picture, const hal::Frame& frame,
                           const render::View& view, std::int64_t deadline_ns) {
  const unsigned framebuffer = display_.framebuffer();
  if (picture.light_field) {
    const double left_ms = 1e-6 * static_cast<double>(deadline_ns - clock_.now_ns());
    viewer_.draw(*picture.light_field, view, framebuffer, kBudgetShare * left_ms);
  } else if (frame.color) {
    overlay_->draw_image(*frame.color, *live_, view, 1.0F, framebuffer);
  } else {
    render::gl::begin(framebuffer, display_.width(), display_.height(), render::gl::Blend::Replace);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
  }
}

void Screen::draw_text(const Picture& picture) {
  overlay_->draw_text(text_of(picture, display_.width(), display_.height()), display_.width(),
                      display_.height(), display_.framebuffer());
}

std::vector<render::Text> text_of(const Picture& picture, int width, int height) {
  const auto bottom = static_cast<float>(height);
  const float size = std::max(kSmallest, bottom / 26.0F);
  const float margin = 0.6F * size;
  const float step = 1.4F * size;  // from line to line
  const auto wrap = [&](const std::string& text, float letter_size) {
    const float room = static_cast<float>(width) - 2.0F * margin;
    const float letters = std::max(1.0F, room / (kLetterWidth * letter_size));
    return wrapped(text, static_cast<std::size_t>(letters));
  };
  std::vector<render::Text> lines;
  float baseline = margin + size;
  lines.push_back({picture.title, margin, baseline, size, kWhite});
  const float small_size = std::max(kSmallest, 0.8F * size);
  const auto add_below = [&](const std::string& text, const render::Color& color) {
    for (const std::string& line : wrap(text, small_size)) {
      baseline += step;
      lines.push_back({line, margin, baseline, small_size, color});
    }
  };
  if (!picture.details.empty()) add_below(picture.details, kWhite);
  for (const std::string& alert : picture.alerts) add_below(alert, kRed);
  for (const std::string& figure : picture.figures) add_below(figure, kGrey);
  if (picture.advice.empty()) return lines;
  const std::vector<std::string> advice = wrap(picture.advice, size);
  baseline = bottom - margin - step * static_cast<float>(advice.size() - 1);
  for (const std::string& line : advice) {
    lines.push_back({line, margin, baseline, size, kYellow});
    baseline += step;
  }
  return lines;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t letters) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (text.size() - begin > letters) {
    const std::size_t space = text.rfind(' ', begin + letters);
    const bool between_words = space != std::string::npos && space > begin;
    const std::size_t end = between_words ? space : begin + letters;
    lines.push_back(text.substr(begin, end - begin));
    begin = between_words ? end + 1 : end;
  }
  lines.push_back(text.substr(begin));
  return lines;
}

geometry::Camera fitted_camera(const geometry::Camera& camera, int width, int height) {
  config::CameraProfile profile = camera.undistorted().profile();
  const double scale = std::min(static_cast<double>(width) / profile.width,
                                static_cast<double>(height) / profile.height);
  // Pixel centres are at integers: the picture's middle is at (width - 1) / 2.
  profile.cx = scale * (profile.cx - 0.5 * (profile.width - 1)) + 0.5 * (width - 1);
  profile.cy = scale * (profile.cy - 0.5 * (profile.height - 1)) + 0.5 * (height - 1);
  profile.fx *= scale;
  profile.fy *= scale;
  profile.width = width;
  profile.height = height;
  return geometry::Camera(profile);
}

}  // namespace lumibox::app
