#include <fcntl.h>
#include <libudev.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "hal/device_files.h"
#include "hal/owned.h"
#include "hal/v4l2/video_system.h"

namespace lumibox::hal::v4l2 {
namespace {

namespace fs = std::filesystem;

class LinuxVideoDevice : public VideoDevice {
 public:
  explicit LinuxVideoDevice(File file) : file_(std::move(file)) {}

  int ioctl(unsigned long request, void* argument) override {
    int status = 0;
    do {
      status = ::ioctl(poll_fd(), request, argument);
    } while (status < 0 && errno == EINTR);
    return status < 0 ? errno : 0;
  }

  std::span<std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    void* memory = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, poll_fd(), offset);
    if (memory == MAP_FAILED) return {};
    return {static_cast<std::uint8_t*>(memory), length};
  }

  void unmap(std::span<std::uint8_t> memory) override { munmap(memory.data(), memory.size()); }

  bool hung_up() override {
    pollfd state{poll_fd(), POLLIN, 0};
    return poll(&state, 1, 0) > 0 && (state.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
  }

  int poll_fd() const override { return file_.descriptor(); }

 private:
  File file_;
};

/// Tells through udev that video devices come and go. Where udev does not run nothing is told.
class UdevWatch {
 public:
  UdevWatch() : udev_(udev_new()) {
    if (udev_ == nullptr) return;
    monitor_ = udev_monitor_new_from_netlink(udev_, "udev");
    if (monitor_ == nullptr) return;
    udev_monitor_filter_add_match_subsystem_devtype(monitor_, "video4linux", nullptr);
    if (udev_monitor_enable_receiving(monitor_) >= 0) fd_ = udev_monitor_get_fd(monitor_);
  }
  ~UdevWatch() {
    udev_monitor_unref(monitor_);
    udev_unref(udev_);
  }
  UdevWatch(const UdevWatch&) = delete;
  UdevWatch& operator=(const UdevWatch&) = delete;

  int fd() const { return fd_; }

  bool changed() {
    bool any = false;
    if (fd_ < 0) return any;
    while (udev_device* device = udev_monitor_receive_device(monitor_)) {
      udev_device_unref(device);
      any = true;
    }
    return any;
  }

 private:
  udev* udev_ = nullptr;
  udev_monitor* monitor_ = nullptr;
  int fd_ = -1;
};

constexpr std::string_view kPrefix = "video";

/// 7 of "video7".
std::optional<int> number_of_node(std::string_view name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  const char* const end = name.data() + name.size();
  int number = 0;
  const auto [stop, status] = std::from_chars(name.data() + kPrefix.size(), end, number);
  return status == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

/// The names that udev gives the nodes, which do not depend on the order of plugging.
std::string stable_path_of(const fs::path& node) {
  for (const fs::path& link : device_files("/dev/v4l/by-id")) {
    std::error_code gone;
    if (fs::equivalent(link, node, gone)) return link.string();
  }
  return {};
}

class LinuxVideoSystem : public VideoSystem {
 public:
  std::vector<Node> nodes() override {
    std::vector<std::pair<int, fs::path>> found;
    for (const fs::path& path : device_files("/dev", kPrefix)) {
      if (const auto number = number_of_node(path.filename().string())) {
        found.emplace_back(*number, path);
      }
    }
    std::ranges::sort(found);
    std::vector<Node> nodes;
    for (const auto& [number, path] : found) nodes.push_back({path.string(), stable_path_of(path)});
    return nodes;
  }

  Opened open(const std::string& path) override {
    File file(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (file.descriptor() < 0) return {nullptr, errno};
    return {std::make_unique<LinuxVideoDevice>(std::move(file)), 0};
  }

  bool changed() override { return watch_.changed(); }
  int watch_fd() const override { return watch_.fd(); }

 private:
  UdevWatch watch_;
};

}  // namespace

std::unique_ptr<VideoSystem> linux_video_system() {
  return std::make_unique<LinuxVideoSystem>();
}

}  // namespace lumibox::hal::v4l2
