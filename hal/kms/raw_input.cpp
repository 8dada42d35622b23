#include "hal/kms/raw_input.h"

#include <csignal>

namespace lumibox::hal::kms {
namespace {

/// The kernel stops a program in the background that touches its terminal, unless this is blocked.
void set(int file, const termios& how) {
  sigset_t stop{};
  sigset_t before{};
  sigemptyset(&stop);
  sigaddset(&stop, SIGTTOU);
  pthread_sigmask(SIG_BLOCK, &stop, &before);
  tcsetattr(file, TCSAFLUSH, &how);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

RawInput::RawInput(int file) : file_(file) {
  termios now{};
  if (tcgetattr(file, &now) != 0) return;
  before_ = now;
  now.c_lflag &= ~static_cast<tcflag_t>(ISIG | ICANON | IEXTEN | ECHO | ECHONL);
  now.c_iflag &= ~static_cast<tcflag_t>(IXON | BRKINT | IMAXBEL);
  set(file, now);
}

RawInput::~RawInput() {
  restore();
}

void RawInput::restore() const {
  if (before_) set(file_, *before_);
}

}  // namespace lumibox::hal::kms
