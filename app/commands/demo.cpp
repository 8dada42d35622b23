#include "app/demo.h"

#include <cstdio>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"

namespace lumibox::app {

void demo(const DemoOptions& options) {
  refuse_recorded(options.out);
  make_folder(options.out);
  config::Config config = load_config(options.sources);
  config.loop.rate_hz = options.rate_hz;
  run_demo(config, options.out);
  std::printf("see %s\n", options.out.c_str());
}

}  // namespace lumibox::app
