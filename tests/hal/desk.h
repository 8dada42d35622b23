#pragma once

#include <sys/types.h>

#include <array>
#include <memory>

struct _XDisplay;

namespace lumibox::testing {

/// A desktop (X11) of its own for tests, without a screen: Xvfb. Where that is missing, the desktop
/// that the tests were started on, if any. $DISPLAY names it.
class Desktop {
 public:
  Desktop();
  ~Desktop();
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;

 private:
  pid_t server_ = -1;
};

/// Someone at the desktop: sees, resizes, types into and closes the window that is called Lumibox.
class Desk {
 public:
  static std::unique_ptr<Desk> open();  ///< null where there is no desktop
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  bool sees_window() const { return window() != 0; }

  /// Red, green and blue of the window at a place, pixels from the top left.
  std::array<int, 3> color_at(int x, int y) const;

  void resize(unsigned width, unsigned height) const;
  void type(unsigned code, bool down) const;  ///< a key by the kernel's code
  void close() const;

 private:
  explicit Desk(_XDisplay* server) : server_(server) {}
  unsigned long window() const;

  _XDisplay* server_;
};

}  // namespace lumibox::testing
