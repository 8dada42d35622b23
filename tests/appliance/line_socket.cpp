#include "appliance/line_socket.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>
#include <thread>

namespace lumibox::testing {

using Clock = std::chrono::steady_clock;

LineSocket::LineSocket(const std::filesystem::path& socket, const std::function<bool()>& may_come)
    : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket.string().size() >= sizeof address.sun_path) {
    ::close(socket_);
    throw std::runtime_error(socket.string() + ": the path is too long for a socket");
  }
  std::strcpy(address.sun_path, socket.c_str());
  const auto end = Clock::now() + kPatience;
  while (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    if (Clock::now() > end || !may_come()) {
      ::close(socket_);
      throw std::runtime_error(socket.string() +
                               ": QEMU does not answer; qemu.log beside it may say why");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

LineSocket::~LineSocket() {
  ::close(socket_);
}

void LineSocket::write(const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const auto n = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) throw std::runtime_error("QEMU has closed its socket");
    sent += static_cast<std::size_t>(n);
  }
}

std::string LineSocket::read_line(std::chrono::seconds patience) {
  const auto end = Clock::now() + patience;
  for (;;) {
    if (const auto at = received_.find('\n'); at != std::string::npos) {
      std::string line = received_.substr(0, at);
      received_.erase(0, at + 1);
      while (!line.empty() && line.back() == '\r') line.pop_back();
      return line;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd poll{socket_, POLLIN, 0};
    char bytes[4096];
    if (left.count() <= 0 || ::poll(&poll, 1, static_cast<int>(left.count())) <= 0) {
      throw std::runtime_error("the guest is silent; it last said: " + received_);
    }
    const auto n = ::recv(socket_, bytes, sizeof bytes, 0);
    if (n <= 0) throw std::runtime_error("QEMU has ended");
    received_.append(bytes, static_cast<std::size_t>(n));
  }
}

}  // namespace lumibox::testing
