#include <cstdio>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "hal/new_folder.h"
#include "lightfield/capture.h"

namespace lumibox::app {
void export_data_set(const ExportOptions& options) {
  const config::Config config = load_config(options.sources);
  hal::require_new_folder(options.out);
  refuse_recorded(options.out);
  const lightfield::Capture capture = lightfield::load_capture(options.capture);
  const auto format = options.format == "colmap" ? lightfield::ExportFormat::Colmap
                                                 : lightfield::ExportFormat::Nerfstudio;
  lightfield::export_capture(capture, format, options.out, config.capture.jpeg_quality);
  std::printf("%zu perspectives in %s\n", capture.light_field.perspectives().size(),
              options.out.c_str());
}

}  // namespace lumibox::app
