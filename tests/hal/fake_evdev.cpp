#include "hal/fake_evdev.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>

namespace lumibox::testing {
namespace {

/// By device and inode of their pipes.
std::map<std::pair<dev_t, ino_t>, FakeEvdev*>& devices() {
  static std::map<std::pair<dev_t, ino_t>, FakeEvdev*> all;
  return all;
}

FakeEvdev* device_at(int fd) {
  struct stat status {};
  if (devices().empty() || fstat(fd, &status) != 0) {
    return nullptr;
  }
  const auto device = devices().find({status.st_dev, status.st_ino});
  return device == devices().end() ? nullptr : device->second;
}

void set_bit(std::span<unsigned char> bits, unsigned bit) {
  if (bit / 8 < bits.size()) {
    bits[bit / 8] = static_cast<unsigned char>(bits[bit / 8] | (1U << (bit % 8)));
  }
}

}  // namespace

FakeEvdev::FakeEvdev(std::filesystem::path path, std::string name, std::set<unsigned> keys,
                     const hal::Clock& clock)
    : path_(std::move(path)), name_(std::move(name)), keys_(std::move(keys)), clock_(clock) {
  struct stat status {};
  if (mkfifo(path_.c_str(), 0600) != 0 ||
      (pipe_ = open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) < 0 ||
      fstat(pipe_, &status) != 0) {
    throw std::runtime_error("no pipe at " + path_.string());
  }
  devices()[{status.st_dev, status.st_ino}] = this;
}

FakeEvdev::~FakeEvdev() {
  std::erase_if(devices(), [&](const auto& entry) { return entry.second == this; });
  close(pipe_);
}

void FakeEvdev::key(unsigned code, int value) {
  change_silently(code, value != 0);
  send(EV_KEY, code, value);
  send(EV_SYN, SYN_REPORT, 0);
}

void FakeEvdev::change_silently(unsigned code, bool down) {
  if (down) {
    down_.insert(code);
  } else {
    down_.erase(code);
  }
}

void FakeEvdev::drop() {
  send(EV_SYN, SYN_DROPPED, 0);
  send(EV_SYN, SYN_REPORT, 0);
}

void FakeEvdev::unplug() {
  is_unplugged_ = true;
  std::filesystem::remove(path_);
}

/// By the real time unless the reader has asked for the monotonic one.
void FakeEvdev::send(unsigned type, unsigned code, int value) {
  constexpr std::int64_t kFarAway = 1'700'000'000;
  const std::int64_t us = clock_.now_ns() / 1000;
  input_event event{};
  event.input_event_sec = us / 1'000'000 + (is_monotonic_ ? 0 : kFarAway);
  event.input_event_usec = us % 1'000'000;
  event.type = static_cast<std::uint16_t>(type);
  event.code = static_cast<std::uint16_t>(code);
  event.value = value;
  if (write(pipe_, &event, sizeof event) != sizeof event) {
    throw std::runtime_error("a pipe that is full");
  }
}

int FakeEvdev::answer(unsigned long request, void* argument) {
  if (is_unplugged_) {
    return -ENODEV;
  }
  const unsigned number = _IOC_NR(request);
  const std::span answer(static_cast<unsigned char*>(argument),
                         _IOC_DIR(request) == _IOC_READ ? _IOC_SIZE(request) : 0);
  std::ranges::fill(answer, static_cast<unsigned char>(0));
  if (request == EVIOCSCLOCKID) {
    is_monotonic_ = *static_cast<int*>(argument) == CLOCK_MONOTONIC;
  } else if (request == EVIOCGRAB) {
    if (is_grabbed_by_another_) {
      return -EBUSY;
    }
    is_grabbed_ = argument != nullptr;
  } else if (number == _IOC_NR(EVIOCGNAME(0))) {
    std::memcpy(answer.data(), name_.c_str(), std::min(answer.size(), name_.size() + 1));
  } else if (number == _IOC_NR(EVIOCGBIT(0, 0))) {
    set_bit(answer, EV_SYN);
    set_bit(answer, EV_KEY);
  } else if (number == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) {
    for (const unsigned code : keys_) set_bit(answer, code);
  } else if (number == _IOC_NR(EVIOCGKEY(0))) {
    for (const unsigned code : down_) set_bit(answer, code);
  }
  return static_cast<int>(answer.size());
}

}  // namespace lumibox::testing

// These stand before the C library's for the whole program.
extern "C" {

int ioctl(int fd, unsigned long request, ...) noexcept {
  std::va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (lumibox::testing::FakeEvdev* const device = lumibox::testing::device_at(fd)) {
    const int result = device->answer(request, argument);
    if (result >= 0) {
      return result;
    }
    errno = -result;
    return -1;
  }
  return static_cast<int>(syscall(SYS_ioctl, fd, request, argument));
}

ssize_t read(int fd, void* buffer, size_t size) {
  const lumibox::testing::FakeEvdev* const device = lumibox::testing::device_at(fd);
  if (device != nullptr && device->is_unplugged()) {
    errno = ENODEV;
    return -1;
  }
  return syscall(SYS_read, fd, buffer, size);
}

}  // extern "C"
