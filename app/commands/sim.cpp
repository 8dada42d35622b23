#include <cstdio>

#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "hal/new_folder.h"
#include "hal/sim/scene.h"

namespace lumibox::app {

void simulate(const SimOptions& options) {
  load_config(options.sources);
  hal::require_new_folder(options.out);
  refuse_recorded(options.out);
  const auto scene = options.scene ? hal::load_scene(*options.scene)
                                   : hal::make_scene(hal::sim::random_scene(*options.random_scene));
  make_parent_folder(options.out);
  {
    Progress progress("simulating", scene->frame_count());
    hal::write_sequence(*scene, options.out,
                        [&](std::int64_t done, std::int64_t) { progress.show(done); });
  }
  std::printf("%lld frames in %s\n", static_cast<long long>(scene->frame_count()),
              options.out.c_str());
}

}  // namespace lumibox::app
