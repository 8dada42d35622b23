#include "hal/kms/virtual_terminal.h"

#include <linux/kd.h>
#include <linux/vt.h>
#include <sys/ioctl.h>

#include <array>
#include <atomic>
#include <csignal>

namespace lumibox::hal::kms {
namespace {

constexpr int kLeaveSignal = SIGUSR1;
constexpr int kReturnSignal = SIGUSR2;
constexpr std::array kCrashes = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};

std::atomic<int> asked_signal = 0;  // the handler may run on any thread
static_assert(std::atomic<int>::is_always_lock_free, "or a handler may not touch it");
std::atomic<const VirtualTerminal*> crash_terminal = nullptr;

void note(int signal) {
  asked_signal = signal;
}

void to_text(int file) {
  vt_mode automatic{};
  automatic.mode = VT_AUTO;
  ioctl(file, KDSETMODE, KD_TEXT);
  ioctl(file, VT_SETMODE, &automatic);
}

void give_back_and_crash(int signal) {
  crash_terminal.load()->give_back();
  std::raise(signal);  // handled as if there were no handler: it was for one time
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(signal, &action, nullptr);
}

/// Leaves alone what a sanitizer or a debugger handles.
void handle_crash(int signal, void (*from)(int), void (*to)(int), int flags) {
  struct sigaction now {};
  sigaction(signal, nullptr, &now);
  if ((now.sa_flags & SA_SIGINFO) == 0 && now.sa_handler == from) handle(signal, to, flags);
}

}  // namespace

std::unique_ptr<VirtualTerminal> VirtualTerminal::on(int file) {
  vt_mode asking{};
  asking.mode = VT_PROCESS;
  asking.relsig = kLeaveSignal;
  asking.acqsig = kReturnSignal;
  vt_mode before{};
  if (ioctl(file, VT_GETMODE, &before) != 0) return nullptr;
  asked_signal = 0;
  handle(kLeaveSignal, note, SA_RESTART);
  handle(kReturnSignal, note, SA_RESTART);
  if (ioctl(file, KDSETMODE, KD_GRAPHICS) != 0 || ioctl(file, VT_SETMODE, &asking) != 0) {
    to_text(file);  // as far as it may: a console of somebody else
    return nullptr;
  }
  std::unique_ptr<VirtualTerminal> terminal(new VirtualTerminal(file));
  crash_terminal = terminal.get();
  for (const int crash : kCrashes) handle_crash(crash, SIG_DFL, give_back_and_crash, SA_RESETHAND);
  return terminal;
}

VirtualTerminal::~VirtualTerminal() {
  for (const int crash : kCrashes) handle_crash(crash, give_back_and_crash, SIG_DFL, 0);
  give_back();
  handle(kLeaveSignal, SIG_IGN, 0);  // one may be on its way
  handle(kReturnSignal, SIG_IGN, 0);
}

void VirtualTerminal::give_back() const {
  to_text(file_);
  input_.restore();
}

Terminal::Request VirtualTerminal::take_request() {
  const int signal = asked_signal.exchange(0);
  if (signal == kLeaveSignal) return Request::Leave;
  if (signal == kReturnSignal) return Request::Return;
  return Request::None;
}

void VirtualTerminal::let_go() {
  ioctl(file_, VT_RELDISP, 1);
}

void VirtualTerminal::take_back() {
  ioctl(file_, VT_RELDISP, VT_ACKACQ);
}

}  // namespace lumibox::hal::kms
