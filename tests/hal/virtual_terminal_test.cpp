// The console that the box has for itself: a terminal whose ioctl() of consoles, which only the
// kernel's own have, are answered here.

#include "hal/kms/virtual_terminal.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/kd.h>
#include <linux/vt.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

/// What the program told its console, and whether that is one.
std::vector<std::string> told;
bool is_console = true;

}  // namespace

extern "C" int ioctl(int file, unsigned long request, ...) noexcept {
  va_list list;
  va_start(list, request);
  void* const argument = va_arg(list, void*);
  va_end(list);
  switch (request) {
    case VT_GETMODE:
      return is_console ? 0 : -1;
    case VT_SETMODE:
      told.emplace_back(static_cast<vt_mode*>(argument)->mode == VT_AUTO ? "auto" : "ask");
      return 0;
    case KDSETMODE:
      told.emplace_back(argument == nullptr ? "text" : "graphics");
      return 0;
    case VT_RELDISP:
      told.emplace_back("switch");
      return 0;
    default:
      return static_cast<int>(syscall(SYS_ioctl, file, request, argument));
  }
}

namespace lumibox::hal::kms {
namespace {

using ::testing::ElementsAre;
using ::testing::ExitedWithCode;
using ::testing::IsEmpty;
using ::testing::KilledBySignal;

/// A terminal and the keyboard on its other end.
class VirtualTerminalTest : public ::testing::Test {
 protected:
  VirtualTerminalTest() {
    grantpt(keyboard_);
    unlockpt(keyboard_);
    file_ = open(ptsname(keyboard_), O_RDWR | O_NOCTTY);
    told.clear();
    is_console = true;
  }
  ~VirtualTerminalTest() override {
    close(file_);
    close(keyboard_);
  }

  termios settings() const {
    termios now{};
    EXPECT_EQ(tcgetattr(file_, &now), 0);
    return now;
  }

  void type(const std::string& keys) const {
    EXPECT_EQ(write(keyboard_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }

  /// Waits for what was typed.
  bool has_input() const {
    pollfd terminal{file_, POLLIN, 0};
    return poll(&terminal, 1, 60'000) == 1;
  }

  int keyboard_ = posix_openpt(O_RDWR | O_NOCTTY);
  int file_ = -1;
};

TEST_F(VirtualTerminalTest, IsInGraphicsModeAndAskedBeforeItIsSwitched) {
  auto terminal = VirtualTerminal::on(file_);
  ASSERT_TRUE(terminal);
  EXPECT_THAT(told, ElementsAre("graphics", "ask"));
  std::raise(SIGUSR1);
  EXPECT_EQ(terminal->take_request(), Terminal::Request::Leave);
  terminal->let_go();
  std::raise(SIGUSR2);
  EXPECT_EQ(terminal->take_request(), Terminal::Request::Return);
  EXPECT_EQ(terminal->take_request(), Terminal::Request::None);
  told.clear();
  terminal.reset();
  EXPECT_THAT(told, ElementsAre("text", "auto"));
}

TEST_F(VirtualTerminalTest, WhatIsNoConsoleIsLeftAlone) {
  is_console = false;
  const termios before = settings();
  EXPECT_FALSE(VirtualTerminal::on(file_));
  EXPECT_THAT(told, IsEmpty());
  EXPECT_EQ(settings().c_lflag, before.c_lflag);
}

TEST_F(VirtualTerminalTest, IsDeafToWhatIsTypedAndAsItWasInTheEnd) {
  const termios before = settings();
  ASSERT_NE(before.c_lflag & ISIG, 0U);
  auto terminal = VirtualTerminal::on(file_);
  EXPECT_EQ(settings().c_lflag & static_cast<tcflag_t>(ISIG | ICANON | ECHO), 0U);
  EXPECT_EQ(settings().c_iflag & IXON, 0U) << "Ctrl+S would hold up the log";
  EXPECT_EQ(settings().c_oflag, before.c_oflag);
  type("rm -r captures\n");
  ASSERT_TRUE(has_input()) << "the kernel brings it there in its own time";
  terminal.reset();
  EXPECT_EQ(settings().c_lflag, before.c_lflag);
  EXPECT_EQ(settings().c_iflag, before.c_iflag);
  int waiting = -1;
  EXPECT_EQ(ioctl(file_, FIONREAD, &waiting), 0);
  EXPECT_EQ(waiting, 0) << "a shell would do it";
}

/// Whether the program whose console this is lives to read the keys that end one.
void read_deadly_keys(int keyboard, int file) {
  setsid();
  if (ioctl(file, TIOCSCTTY, nullptr) != 0) std::_Exit(2);
  const auto terminal = VirtualTerminal::on(file);
  const std::string keys = "\x03\x1c\x1a\n";
  if (write(keyboard, keys.data(), keys.size()) != static_cast<ssize_t>(keys.size())) std::_Exit(3);
  for (char key = 0; key != '\n';) {
    if (read(file, &key, 1) != 1) std::_Exit(4);
  }
  std::_Exit(0);
}

TEST_F(VirtualTerminalTest, NoKeyEndsTheProgram) {
  EXPECT_EXIT(read_deadly_keys(keyboard_, file_), ExitedWithCode(0), "");
}

TEST_F(VirtualTerminalTest, ListensAgainAfterACrash) {
  const termios before = settings();
  const auto crash = [this] {
    const auto terminal = VirtualTerminal::on(file_);
    std::raise(SIGABRT);  // of all crashes the one that sanitizers leave to the program
  };
  EXPECT_EXIT(crash(), KilledBySignal(SIGABRT), "");
  EXPECT_EQ(settings().c_lflag, before.c_lflag);
}

}  // namespace
}  // namespace lumibox::hal::kms
