#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

namespace lumibox::testing {

/// A service manager that listens.
class ServiceManager {
 public:
  explicit ServiceManager(const std::string& name) : socket_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name.data(), name.size());
    if (name.front() == '@') address.sun_path[0] = '\0';
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), length), 0) << name;
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~ServiceManager() {
    close(socket_);
    for (const char* variable : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) {
      unsetenv(variable);
    }
  }
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  /// What was said since the last call; empty if nothing.
  std::string heard() const {
    std::string all;
    for (std::string more; !(more = receive(MSG_DONTWAIT)).empty();) all += more;
    return all;
  }

  /// What is said until these words are among it; less if nothing is said for a minute.
  std::string heard_until(const std::string& words) const {
    std::string all;
    for (std::string more; all.find(words) == std::string::npos; all += more) {
      if ((more = receive(0)).empty()) break;
    }
    return all;
  }

 private:
  std::string receive(int flags) const {
    const timeval minute{60, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &minute, sizeof minute);
    std::array<char, 512> text{};
    const ssize_t length = recv(socket_, text.data(), text.size(), flags);
    return length < 0 ? std::string() : std::string(text.data(), static_cast<std::size_t>(length));
  }

  int socket_;
};

}  // namespace lumibox::testing
