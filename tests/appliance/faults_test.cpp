#include <gtest/gtest.h>

#include <algorithm>

#include "appliance/box.h"

// What goes wrong with a box in the hand, made to happen: each begins in the middle of a capture,
// and ends with more views than there were.
namespace lumibox::testing {
namespace {

class Faults : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    box_ = std::make_unique<Box>("faults");
    box_->get_devices();
    box_->wait_until_ready();
    box_->expect_status("aim at the subject");
    box_->press(Line::Main);
    box_->expect_status("the sphere is placed");
    box_->press(Line::Main);
    box_->expect_views(2);
  }
  static void TearDownTestSuite() { box_.reset(); }

  void SetUp() override { ASSERT_GE(box().views(), 2) << "there is no capture to disturb"; }

  static Box& box() { return *box_; }
  static VirtualMachine& guest() { return box_->machine(); }
  /// Recording goes on, into the same capture; none of it is lost.
  static void expect_that_it_goes_on(int views_before) {
    box().expect_views(views_before + 1);
    EXPECT_EQ(guest().output("ls /var/lib/lumibox/captures | wc -l"), "1");
  }
  static int restarts() {
    return std::stoi(guest().output("systemctl show --property=NRestarts --value lumibox"));
  }

 private:
  static std::unique_ptr<Box> box_;
};
std::unique_ptr<Box> Faults::box_;

TEST_F(Faults, TheFeederStallsAndGoesOn) {
  const int views = box().views(), before = restarts();
  guest().output("systemctl kill --signal=STOP webcam0");
  box().expect_status("the camera is gone");
  box().look("fault-1-webcam-stalled");
  guest().output("systemctl kill --signal=CONT webcam0");
  expect_that_it_goes_on(views);
  EXPECT_EQ(restarts(), before);
}

TEST_F(Faults, TheWebcamIsUnpluggedAndComesBack) {
  const int views = box().views(), before = restarts();
  guest().output("insmod /run/tools/pull_cable.ko device=/dev/video20");
  box().expect_status("the camera is gone");
  EXPECT_FALSE(guest().output("ls /dev").find("video20") != std::string::npos);
  box().look("fault-2-webcam-unplugged");
  box().play(1);
  expect_that_it_goes_on(views);
  EXPECT_EQ(restarts(), before);
}

/// The camera's picture is on the screen again.
bool shows_the_film(const hal::Image& screen) {
  return likeness_to_film(screen).best > 20.0;
}

TEST_F(Faults, AnotherConsoleAndBack) {
  const int views = box().views(), before = restarts();
  guest().type("ctrl-alt-f2");
  EXPECT_TRUE(guest().becomes_true("grep -q tty2 /sys/class/tty/tty0/active"));
  EXPECT_TRUE(box().comes_to_show([](const auto& screen) { return !shows_the_film(screen); }));
  guest().type("ctrl-alt-f1");
  EXPECT_TRUE(box().comes_to_show(shows_the_film));
  expect_that_it_goes_on(views);
  EXPECT_EQ(restarts(), before);
}

TEST_F(Faults, TheServiceIsKilled) {
  const int views = box().views(), before = restarts();
  guest().output("systemctl kill --signal=KILL lumibox");
  EXPECT_TRUE(guest().becomes_true("[ $(systemctl show --property=NRestarts --value lumibox) -gt " +
                                   std::to_string(before) + " ]"));
  box().wait_until_ready();
  box().look("fault-3-after-a-kill");
  EXPECT_GE(box().views(), views);
  expect_that_it_goes_on(views);
}

TEST_F(Faults, TheServiceHangs) {
  const int views = box().views(), before = restarts();
  guest().output("systemctl kill --signal=STOP lumibox");
  EXPECT_TRUE(guest().becomes_true("[ $(systemctl show --property=NRestarts --value lumibox) -gt " +
                                   std::to_string(before) + " ]"));
  EXPECT_EQ(guest().run("journalctl -b -u lumibox | grep -qi watchdog").status, 0);
  box().wait_until_ready();
  EXPECT_GE(box().views(), views);
  expect_that_it_goes_on(views);
}

/// Rows of the screen with something bright in them.
int bright_rows(const hal::Image& screen) {
  int rows = 0;
  for (int y = 0; y < screen.height(); ++y) {
    const auto* row = screen.row(y);
    rows += std::any_of(row, row + screen.stride(), [](int value) { return value > 150; }) ? 1 : 0;
  }
  return rows;
}

// The last of this suite: after it there is no box that runs.
TEST_F(Faults, SettingsThatNeverWorkedAreSaidOnTheScreen) {
  // A try takes the guest ten times as long as it takes a board.
  guest().output(
      "mkdir -p /run/systemd/system/lumibox.service.d && cd /run/systemd/system/lumibox.service.d "
      "&& "
      "printf '[Unit]\nStartLimitIntervalSec=1h\n' > slow.conf && systemctl daemon-reload && "
      "systemctl stop lumibox && cd /var/lib/lumibox && rm last-good.toml && echo nonsense > "
      "lumibox.toml");
  guest().run("systemctl start lumibox");
  EXPECT_TRUE(guest().becomes_true("systemctl is-active --quiet lumibox-failed"));
  EXPECT_EQ(guest().run("systemctl is-failed lumibox").status, 0);
  const auto is_text = [](const hal::Image& screen) {
    const int rows = bright_rows(screen);  // a few lines of it, and nothing below
    return rows > 20 && rows < screen.height() / 2;
  };
  EXPECT_TRUE(box().comes_to_show(is_text));
  box().look("fault-4-given-up");
  EXPECT_EQ(guest().run("journalctl -b -u lumibox | grep -q lumibox.toml").status, 0);
}

}  // namespace
}  // namespace lumibox::testing
