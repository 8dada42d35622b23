#include <cstdio>

#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "hal/v4l2/camera_list.h"

namespace lumibox::app {

void show_cameras(const CamerasOptions& options) {
  load_config(options.sources);  // refuses what is wrong with it, and sets the level of the log
  std::fputs(hal::list_cameras(*hal::v4l2::linux_video_system()).c_str(), stdout);
}

}  // namespace lumibox::app
