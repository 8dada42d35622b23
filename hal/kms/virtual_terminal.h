#pragma once

#include <memory>

#include "hal/kms/terminal.h"

namespace lumibox::hal::kms {

/// A console of the kernel (/dev/tty1), in graphics mode as long as this lives, and then, or when
/// the program crashes, in text mode again. There is one of these at a time: it handles the signals
/// SIGUSR1 and SIGUSR2.
class VirtualTerminal : public Terminal {
 public:
  /// None if the file is not a console that is lent to this program, such as a pipe, a file or a
  /// window of a desktop.
  static std::unique_ptr<VirtualTerminal> on(int file);

  ~VirtualTerminal() override;
  VirtualTerminal(const VirtualTerminal&) = delete;
  VirtualTerminal& operator=(const VirtualTerminal&) = delete;

  Request take_request() override;
  void let_go() override;
  void take_back() override;

 private:
  explicit VirtualTerminal(int file) : file_(file) {}

  int file_;
};

}  // namespace lumibox::hal::kms
