#include "app/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "support/service_manager.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(ServiceReport, IsReadyOnceAPictureIsOnTheScreen) {
  ServiceReport report(3 * kSecond_ns);
  EXPECT_EQ(report.say(0, 0, "looking around"), "");
  EXPECT_EQ(report.say(5 * kSecond_ns, 0, "looking around"), "") << "not even alive before that";
  EXPECT_EQ(report.say(6 * kSecond_ns, 1, "looking around"),
            "READY=1\nWATCHDOG=1\nSTATUS=looking around\n");
  EXPECT_EQ(report.say(6 * kSecond_ns + 1, 2, "looking around"), "");
}

TEST(ServiceReport, IsAliveThreeTimesPerWatchdog) {
  ServiceReport report(3 * kSecond_ns);
  int signs = 0;
  for (int tick = 1; tick <= 300; ++tick) {  // ten seconds of thirty ticks
    const std::string lines = report.say(tick * kSecond_ns / 30, tick, "capture");
    signs += lines.find("WATCHDOG=1") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(signs, 10);
}

TEST(ServiceReport, ATickingLoopBeforeAFrozenScreenIsNotAlive) {
  ServiceReport report(3 * kSecond_ns);
  report.say(0, 1, "capture");
  for (int second = 1; second < 20; ++second) {
    EXPECT_THAT(report.say(second * kSecond_ns, 1, "capture"), Not(HasSubstr("WATCHDOG=1")));
  }
  EXPECT_THAT(report.say(20 * kSecond_ns, 2, "capture"), HasSubstr("WATCHDOG=1"));
}

TEST(ServiceReport, SaysNothingOfLifeToWhoDoesNotWatch) {
  ServiceReport report(std::nullopt);
  EXPECT_EQ(report.say(kSecond_ns, 1, ""), "READY=1\n");
  EXPECT_EQ(report.say(100 * kSecond_ns, 9, ""), "");
}

TEST(ServiceReport, TellsAStateThatChangedButNotEveryTick) {
  ServiceReport report(std::nullopt);
  report.say(0, 1, "capture  1 views");
  EXPECT_EQ(report.say(kSecond_ns, 2, "capture  2 views"), "");
  EXPECT_EQ(report.say(2 * kSecond_ns, 3, "capture  3 views"), "STATUS=capture  3 views\n");
  EXPECT_EQ(report.say(9 * kSecond_ns, 4, "capture  3 views"), "");
}

// Whatever the rates, a box that ticks in time is never silent for as long as the watchdog waits.
RC_GTEST_PROP(ServiceReportProperty, ABoxThatIsWellIsNeverRestarted, ()) {
  const std::int64_t watchdog_ns = *rc::gen::inRange<std::int64_t>(kSecond_ns, 60 * kSecond_ns);
  const std::int64_t slowest_ns = watchdog_ns / 2;
  ServiceReport report(watchdog_ns);
  std::int64_t now_ns = 0;
  std::int64_t last_ns = 0;
  for (int tick = 1; tick < 100; ++tick) {
    now_ns += *rc::gen::inRange<std::int64_t>(1, slowest_ns);
    if (report.say(now_ns, tick, "").find("WATCHDOG=1") != std::string::npos) last_ns = now_ns;
    RC_ASSERT(last_ns > 0 && now_ns - last_ns < watchdog_ns);
  }
}

TEST(Service, TellsTheManagerThatStartedIt) {
  const testing::TempDir dir;
  for (const std::string& name :
       {(dir / "notify").string(), "@lumibox-test-" + std::to_string(getpid())}) {
    const testing::ServiceManager manager(name);
    setenv("WATCHDOG_USEC", "3000000", 1);
    setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
    Service service;
    service.tick(0, 0, "looking around");
    EXPECT_EQ(manager.heard(), "");
    service.tick(kSecond_ns, 1, "looking around");
    EXPECT_EQ(manager.heard(), "READY=1\nWATCHDOG=1\nSTATUS=looking around\n") << name;
    service.tick(2 * kSecond_ns, 2, "looking around");
    EXPECT_EQ(manager.heard(), "WATCHDOG=1\n");
    service.stopping();
    EXPECT_EQ(manager.heard(), "STOPPING=1\n");
  }
}

TEST(Service, AnotherProcessIsWatchedAndNotThisOne) {
  const testing::ServiceManager manager("@lumibox-other-" + std::to_string(getpid()));
  setenv("WATCHDOG_USEC", "3000000", 1);
  setenv("WATCHDOG_PID", "1", 1);
  Service service;
  service.tick(kSecond_ns, 1, "");
  EXPECT_EQ(manager.heard(), "READY=1\n");
}

TEST(Service, WithoutAManagerNothingHappens) {
  unsetenv("NOTIFY_SOCKET");
  Service service;
  service.tick(0, 1, "capture");
  service.stopping();
}

TEST(Service, AManagerThatIsGoneIsReportedOnce) {
  setenv("NOTIFY_SOCKET", "/nowhere/notify", 1);
  Service service;
  ::testing::internal::CaptureStdout();
  service.tick(0, 1, "capture");
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("cannot be told"));
  ::testing::internal::CaptureStdout();
  service.stopping();
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace lumibox::app
