#pragma once

#include <termios.h>

#include <optional>

namespace lumibox::hal::kms {

/// A terminal on which nobody reads what is typed. As long as this lives no key ends or stops the
/// program (Ctrl+C, Ctrl+\, Ctrl+Z), none holds up its output (Ctrl+S), and nothing is echoed; in
/// the end what was typed is thrown away, and all is as before. Another console (Ctrl+Alt+F2) is
/// switched to as ever, for that is the kernel's.
class RawInput {
 public:
  /// `file` must stay open. One that is no terminal is left alone.
  explicit RawInput(int file);
  ~RawInput();
  RawInput(const RawInput&) = delete;
  RawInput& operator=(const RawInput&) = delete;

  /// As before. Only system calls, so it may run in the handler of a crash.
  void restore() const;

 private:
  int file_;
  std::optional<termios> before_;
};

}  // namespace lumibox::hal::kms
