#include <cstdio>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "hal/new_folder.h"
#include "lightfield/capture.h"

namespace lumibox::app {

void import_data_set(const ImportOptions& options) {
  const config::Config config = load_config(options.sources);
  hal::require_new_folder(options.capture);
  refuse_recorded(options.capture);
  const lightfield::Capture capture = lightfield::import_capture(options.source);
  lightfield::save_capture(capture, options.capture, config.capture.jpeg_quality);
  std::printf("%zu perspectives in %s\n", capture.light_field.perspectives().size(),
              options.capture.c_str());
}

}  // namespace lumibox::app
