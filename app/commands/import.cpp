#include <cstdio>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "config/log.h"
#include "hal/new_folder.h"
#include "lightfield/capture.h"
#include "lightfield/scene_points.h"

namespace lumibox::app {
namespace {

std::vector<Eigen::Vector3d> find_points(const std::vector<lightfield::Perspective>& perspectives) {
  std::optional<Progress> line;
  return lightfield::find_scene_points(perspectives, [&](std::int64_t done, std::int64_t total) {
    if (!line) line.emplace("points", total);
    line->show(done);
  });
}

}  // namespace

void import_data_set(const ImportOptions& options) {
  const config::Config config = load_config(options.sources);
  hal::require_new_folder(options.capture);
  refuse_recorded(options.capture);
  const lightfield::Capture capture = lightfield::import_capture(options.source, find_points);
  lightfield::save_capture(capture, options.capture, config.capture.jpeg_quality);
  if (capture.points.empty()) {
    config::log_warning("no points could be found in the pictures; the capture is without");
  }
  std::printf("%zu perspectives and %zu points in %s\n", capture.light_field.perspectives().size(),
              capture.points.size(), options.capture.c_str());
}

}  // namespace lumibox::app
