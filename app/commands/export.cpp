#include <cstdio>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "config/error.h"
#include "hal/new_folder.h"
#include "lightfield/capture.h"

namespace lumibox::app {
namespace {

lightfield::ExportFormat format_named(const std::string& name) {
  if (name == "nerfstudio") {
    return lightfield::ExportFormat::Nerfstudio;
  }
  if (name == "colmap") {
    return lightfield::ExportFormat::Colmap;
  }
  throw config::InputError("--format " + name + ": not available yet: nerfstudio, colmap");
}

}  // namespace

void export_data_set(const ExportOptions& options) {
  const config::Config config = load_config(options.sources);
  const lightfield::ExportFormat format = format_named(options.format);
  hal::require_new_folder(options.out);
  const lightfield::Capture capture = lightfield::load_capture(options.capture);
  lightfield::export_capture(capture, format, options.out, config.capture.jpeg_quality);
  std::printf("%zu perspectives in %s\n", capture.light_field.perspectives().size(),
              options.out.c_str());
}

}  // namespace lumibox::app
