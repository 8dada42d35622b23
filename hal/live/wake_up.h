#pragma once

#include <sys/eventfd.h>

#include <cerrno>

#include "config/error.h"
#include "config/error_text.h"
#include "hal/owned.h"

namespace lumibox::hal::live {

/// Wakes a thread that polls it. Any thread may ring.
class WakeUp {
 public:
  WakeUp() : file_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (fd() < 0) throw config::InputError("eventfd: " + config::error_text(errno));
  }

  int fd() const { return file_.descriptor(); }
  void ring() { eventfd_write(fd(), 1); }
  void clear() {
    eventfd_t count = 0;
    eventfd_read(fd(), &count);
  }

 private:
  File file_;
};

}  // namespace lumibox::hal::live
