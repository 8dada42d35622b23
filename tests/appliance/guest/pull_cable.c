// Pulls the cable of a webcam: takes a video device away while programs have it open, as a USB
// driver does when its camera goes. insmod pull_cable.ko device=/dev/video0
#include <linux/fs.h>
#include <linux/module.h>
#include <media/v4l2-dev.h>

static char* device = "";
module_param(device, charp, 0);

static int __init pull_cable(void) {
  struct file* file = filp_open(device, O_RDWR | O_NONBLOCK, 0);
  if (IS_ERR(file)) return PTR_ERR(file);
  video_unregister_device(video_devdata(file));
  filp_close(file, NULL);
  return 0;
}

// So that it can be removed, and loaded again for the next camera.
static void __exit done(void) {}

module_init(pull_cable);
module_exit(done);
MODULE_DESCRIPTION("Takes a video device away");
MODULE_LICENSE("Dual MIT/GPL");
