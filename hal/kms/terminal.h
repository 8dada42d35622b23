#pragma once

namespace lumibox::hal::kms {

/// The console that the program was started on, which lends it the screen: the kernel asks for it
/// when somebody switches to another console (Ctrl+Alt+F2), and gives it back.
class Terminal {
 public:
  enum class Request { None, Leave, Return };

  virtual ~Terminal() = default;

  /// What the kernel has asked for since the last call.
  virtual Request take_request() = 0;

  virtual void let_go() = 0;     ///< answers Leave: another console may have the screen now
  virtual void take_back() = 0;  ///< answers Return: the screen is ours
};

}  // namespace lumibox::hal::kms
