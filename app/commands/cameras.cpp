#include <cstdio>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "hal/libcamera/libcamera_camera.h"
#include "hal/v4l2/camera_list.h"

namespace lumibox::app {

void show_cameras(const CamerasOptions& options) {
  load_config(options.sources);  // refuses what is wrong with it, and sets the level of the log
  const std::string webcams = hal::list_cameras(*hal::v4l2::linux_video_system());
  std::fputs(webcams.c_str(), stdout);  // also if libcamera does not start
  const std::string others = hal::list_cameras(*hal::libcam::real_camera_system());
  std::fputs(others.c_str(), stdout);
  if (webcams.empty() && others.empty()) std::fputs("no camera found\n", stdout);
}

}  // namespace lumibox::app
