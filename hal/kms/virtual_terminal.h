#pragma once

#include <memory>

#include "hal/kms/raw_input.h"
#include "hal/kms/terminal.h"

namespace lumibox::hal::kms {

/// A console of the kernel (/dev/tty1), in graphics mode and deaf to what is typed as long as this
/// lives, and then, or when the program crashes, as it was again. There is one of these at a time:
/// it handles the signals SIGUSR1 and SIGUSR2.
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

  /// Text, and a keyboard that is listened to. Only system calls: the handler of a crash does it.
  void give_back() const;

 private:
  explicit VirtualTerminal(int file) : file_(file), input_(file) {}

  int file_;
  RawInput input_;
};

}  // namespace lumibox::hal::kms
