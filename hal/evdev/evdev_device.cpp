#include "hal/evdev/evdev_device.h"

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "config/error_text.h"

namespace lumibox::hal {
namespace {

/// In one call, so that a device that never ends does not stop the box.
constexpr int kMostEvents = 4096;

std::int64_t time_of(const input_event& event) {
  return event.input_event_sec * std::int64_t{1'000'000'000} +
         event.input_event_usec * std::int64_t{1000};
}

std::string refusal(const std::filesystem::path& path, int error) {
  if (error == EACCES || error == EPERM) {
    return path.string() + ": no permission; expected a user in the group input";
  }
  if (error == EBUSY) {
    return path.string() + ": another program has it for itself; expected a free device";
  }
  return path.string() + ": " + config::error_text(error) + "; expected an input device";
}

}  // namespace

void EvdevDevice::Free::operator()(libevdev* device) const {
  libevdev_free(device);
}

EvdevDevice::Opened EvdevDevice::open(const std::filesystem::path& path, const EvdevTerms& terms,
                                      std::int64_t now_ns) {
  File file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  const int fd = file.descriptor();
  if (fd < 0) {
    return {nullptr, refusal(path, errno)};
  }
  std::unique_ptr<EvdevDevice> opened(new EvdevDevice(std::move(file), terms));
  libevdev* const device = opened->device_.get();
  if (const int error = -libevdev_set_fd(device, fd); error != 0) {
    return {nullptr, refusal(path, error)};
  }
  const bool has_a_key = std::ranges::any_of(terms.keys, [&](const auto& key) {
    return libevdev_has_event_code(device, EV_KEY, key.first) == 1;
  });
  if (!has_a_key || (!terms.name.empty() && terms.name != opened->name())) {
    return {};
  }
  if (const int error = -libevdev_set_clock_id(device, CLOCK_MONOTONIC); error != 0) {
    return {nullptr, refusal(path, error)};
  }
  if (const int error = terms.grab ? -libevdev_grab(device, LIBEVDEV_GRAB) : 0; error != 0) {
    return {nullptr, refusal(path, error)};
  }
  opened->begin(now_ns);
  return {std::move(opened), {}};
}

EvdevDevice::EvdevDevice(File file, const EvdevTerms& terms)
    : file_(std::move(file)),
      device_(libevdev_new()),
      keys_(terms.keys),
      held_(keys_),
      guard_(terms.stuck_s) {}

std::string EvdevDevice::name() const {
  return libevdev_get_name(device_.get());
}

void EvdevDevice::begin(std::int64_t now_ns) {
  for (const auto& [code, button] : keys_) {
    if (libevdev_get_event_value(device_.get(), EV_KEY, code) != 0) {
      held_.take(code, true, now_ns);
      guard_.held_at_start(button, now_ns);
    }
  }
}

std::vector<ButtonEvent> EvdevDevice::poll(std::int64_t now_ns) {
  std::vector<ButtonEvent> edges;
  if (!gone_ && !read(now_ns, edges)) {
    gone_ = true;
    for (const ButtonEvent& edge : held_.release_all(now_ns)) edges.push_back(edge);
  }
  return guard_.pass(edges, now_ns);
}

/// False when the device is gone. After the kernel has dropped events, libevdev compares its state
/// with the kernel's and makes events of the differences; nobody knows when these were.
bool EvdevDevice::read(std::int64_t now_ns, std::vector<ButtonEvent>& edges) {
  unsigned flag = LIBEVDEV_READ_FLAG_NORMAL;
  for (int i = 0; i < kMostEvents; ++i) {
    input_event event{};
    const int status = libevdev_next_event(device_.get(), flag, &event);
    const bool resyncing = status == LIBEVDEV_READ_STATUS_SYNC;
    if (resyncing || status == LIBEVDEV_READ_STATUS_SUCCESS) {
      if (event.type == EV_KEY) {
        const std::int64_t time_ns = resyncing ? now_ns : time_of(event);
        if (const auto edge = held_.take(event.code, event.value != 0, time_ns)) {
          edges.push_back(*edge);
        }
      }
      if (resyncing) {
        flag = LIBEVDEV_READ_FLAG_SYNC;
      }
    } else if (status != -EINTR) {
      return status == -EAGAIN;
    }
  }
  return true;
}

}  // namespace lumibox::hal
