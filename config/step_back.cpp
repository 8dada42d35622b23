#include "config/step_back.h"

#include <sched.h>

#include "config/log.h"

namespace lumibox::config {

void step_back(const std::string& work) {
  const sched_param none{};
  if (sched_setscheduler(0, SCHED_IDLE, &none) != 0) {
    log_warning(work + " at the loop's own priority");
  }
}

}  // namespace lumibox::config
