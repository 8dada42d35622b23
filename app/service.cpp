#include "app/service.h"

#include <systemd/sd-daemon.h>

#include "config/error_text.h"
#include "config/log.h"

namespace lumibox::app {
namespace {

/// Between two states that are told: for people who look, not a log.
constexpr std::int64_t kStatusEvery_ns = 2'000'000'000;

/// One sign of life may be late, and another one lost.
constexpr std::int64_t kSignsPerWatchdog = 3;

std::optional<std::int64_t> watchdog_ns() {
  std::uint64_t time_us = 0;
  if (sd_watchdog_enabled(/*unset_environment=*/0, &time_us) <= 0) return std::nullopt;
  return static_cast<std::int64_t>(time_us) * 1000;
}

}  // namespace

std::string ServiceReport::say(std::int64_t now_ns, std::int64_t presented,
                               const std::string& status) {
  if (!ready_ && presented == 0) return {};
  std::string lines;
  if (!ready_) lines += "READY=1\n";
  if (alive_is_due(now_ns, presented)) {
    lines += "WATCHDOG=1\n";
    alive_ns_ = now_ns;
    presented_ = presented;
  }
  if (status_is_due(now_ns, status)) {
    lines += "STATUS=" + status + "\n";
    status_ns_ = now_ns;
    status_ = status;
  }
  ready_ = true;
  return lines;
}

bool ServiceReport::alive_is_due(std::int64_t now_ns, std::int64_t presented) const {
  return watchdog_ns_ && presented != presented_ &&
         (!ready_ || now_ns - alive_ns_ >= *watchdog_ns_ / kSignsPerWatchdog);
}

bool ServiceReport::status_is_due(std::int64_t now_ns, const std::string& status) const {
  return status != status_ && (!ready_ || now_ns - status_ns_ >= kStatusEvery_ns);
}

Service::Service() : report_(watchdog_ns()) {}

void Service::tick(std::int64_t now_ns, std::int64_t presented, const std::string& status) {
  const std::string lines = report_.say(now_ns, presented, status);
  if (!lines.empty()) notify(lines);
}

void Service::stopping() {
  notify("STOPPING=1\n");
}

void Service::notify(const std::string& lines) {
  const int error = -sd_notify(/*unset_environment=*/0, lines.c_str());
  if (error <= 0) return;
  if (heard_) {
    config::log_warning("the service manager cannot be told how the box is: " +
                        config::error_text(error));
  }
  heard_ = false;
}

}  // namespace lumibox::app
