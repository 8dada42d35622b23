#pragma once

#include <linux/input-event-codes.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "hal/clock.h"

namespace lumibox::testing {

/// An input device that the kernel does not have. It is a pipe in a folder; the calls of read() and
/// ioctl() that a program makes on it, libevdev's among them, are answered here as the kernel does
/// (Documentation/input/event-codes and drivers/input/evdev.c). Other files are left to the kernel.
class FakeEvdev {
 public:
  FakeEvdev(std::filesystem::path path, std::string name, std::set<unsigned> keys,
            const hal::Clock& clock);
  ~FakeEvdev();
  FakeEvdev(const FakeEvdev&) = delete;
  FakeEvdev& operator=(const FakeEvdev&) = delete;

  /// The key's event, and the end of its packet. 1: pressed, 0: released, 2: repeated.
  void key(unsigned code, int value);

  /// The key changes, and nobody is told.
  void change_silently(unsigned code, bool down);

  /// More happened than the kernel kept: SYN_DROPPED.
  void drop();

  /// Its file is gone and who has it open is told so.
  void unplug();

  void grab_by_another() { is_grabbed_by_another_ = true; }
  bool is_grabbed() const { return is_grabbed_; }

  /// The answer to a request of ioctl(), or -errno.
  int answer(unsigned long request, void* argument);
  bool is_unplugged() const { return is_unplugged_; }

 private:
  void send(unsigned type, unsigned code, int value);

  std::filesystem::path path_;
  std::string name_;
  std::set<unsigned> keys_;
  const hal::Clock& clock_;
  std::set<unsigned> down_;
  int pipe_ = -1;
  bool is_monotonic_ = false;
  bool is_grabbed_ = false;
  bool is_grabbed_by_another_ = false;
  bool is_unplugged_ = false;
};

}  // namespace lumibox::testing
