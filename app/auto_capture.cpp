#include "app/auto_capture.h"

#include <fmt/core.h>

#include <numbers>
#include <utility>

#include "app/placement.h"
#include "config/log.h"

namespace lumibox::app {

AutoCapture::AutoCapture(Recorder& recorder, const geometry::Camera& camera,
                         const config::Capture& options, std::filesystem::path folder,
                         const std::optional<SubjectPixel>& subject)
    : recorder_(recorder),
      camera_(camera),
      options_(options),
      folder_(std::move(folder)),
      subject_(subject.value_or(SubjectPixel{reticle(camera), 0})),
      subject_given_(subject.has_value()),
      placed_(recorder.light_field().subject().has_value()) {}

void AutoCapture::see(const Moment& moment) {
  recorder_.follow_map(moment.map, options_.moved_share);
  if (!placed_ && moment.tracking_is_good() && moment.frame.index >= subject_.frame) {
    place(moment);
  }
  if (placed_ && recorder_.accepts(moment, options_.threshold_deg * std::numbers::pi / 180.0)) {
    recorder_.record(moment);
  }
  recorder_.keep_map(moment);
}

void AutoCapture::place(const Moment& moment) {
  const auto ray = ray_of_pixel(camera_, *moment.tracked.world_from_camera, subject_.pixel);
  const auto depth = ray ? depth_on_ray(*ray, moment.map_points) : std::nullopt;
  if (depth) {
    recorder_.begin(sphere_on_ray(*ray, *depth, options_), moment, folder_);
    recorder_.set_threshold(options_.threshold_deg * std::numbers::pi / 180.0);
    placed_ = true;
    if (subject_given_ && moment.frame.index != subject_.frame) {
      config::log_warning(
          fmt::format("frame {} is not tracked well; the subject is placed in frame {}",
                      subject_.frame, moment.frame.index));
    }
  }
}

}  // namespace lumibox::app
