#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lumibox::app {

/// What the service manager is told of a box, and when: that it is ready, once a picture is on the
/// screen; that it is alive, as long as it ticks and its pictures come on the screen; what it is
/// doing. Pure; the lines are those of sd_notify(3).
class ServiceReport {
 public:
  /// Time after which the manager restarts what says nothing; none if it does not watch.
  explicit ServiceReport(std::optional<std::int64_t> watchdog_ns) : watchdog_ns_(watchdog_ns) {}

  /// What is to be said in this tick; empty if nothing is. `presented` is hal::Display's.
  std::string say(std::int64_t now_ns, std::int64_t presented, const std::string& status);

 private:
  bool alive_is_due(std::int64_t now_ns, std::int64_t presented) const;
  bool status_is_due(std::int64_t now_ns, const std::string& status) const;

  std::optional<std::int64_t> watchdog_ns_;
  bool ready_ = false;
  std::int64_t alive_ns_ = 0;   ///< when it was said last
  std::int64_t presented_ = 0;  ///< as it was then
  std::int64_t status_ns_ = 0;  ///< likewise
  std::string status_;
};

/// The line to the service manager that started this program; to nobody if none did.
class Service {
 public:
  Service();  ///< what the environment says: NOTIFY_SOCKET, WATCHDOG_USEC, WATCHDOG_PID

  void tick(std::int64_t now_ns, std::int64_t presented, const std::string& status);

  /// The box is about to end; bringing its capture to disk may take longer than a watchdog waits.
  void stopping();

 private:
  void notify(const std::string& lines);

  ServiceReport report_;
  bool heard_ = true;  ///< false once nobody could be told
};

}  // namespace lumibox::app
