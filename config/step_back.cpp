#include "config/step_back.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include "config/log.h"

namespace lumibox::config {
namespace {

constexpr int kNice = 10;  // Linux divides the weight by 1.25 for each

void warn(const std::string& work) {
  log_warning(work + " at the loop's own priority");
}

}  // namespace

void step_back(const std::string& work) {
  const sched_param none{};
  if (sched_setscheduler(0, SCHED_IDLE, &none) != 0) warn(work);
}

void give_way(const std::string& work) {
  // On Linux a thread's own, not the process'.
  const int own = getpriority(PRIO_PROCESS, 0);
  if (setpriority(PRIO_PROCESS, 0, own + kNice) != 0) warn(work);
}

}  // namespace lumibox::config
