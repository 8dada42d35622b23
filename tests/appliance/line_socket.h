#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace lumibox::testing {

/// How long the guest may take before a test calls it hung: some five times what it takes on a busy
/// machine. Nothing is ever concluded from how long something took.
constexpr std::chrono::seconds kPatience{240};

/// A connection to a socket of QEMU's, line by line. Throws std::runtime_error on the end of the
/// connection and when `patience` is over.
class LineSocket {
 public:
  /// Waits until the socket is there, as long as `may_come` says that it may.
  LineSocket(const std::filesystem::path& socket, const std::function<bool()>& may_come);
  ~LineSocket();
  LineSocket(const LineSocket&) = delete;
  LineSocket& operator=(const LineSocket&) = delete;

  void write(const std::string& text);
  /// The next line, without its end.
  std::string read_line(std::chrono::seconds patience = kPatience);

 private:
  int socket_ = -1;
  std::string received_;
};

}  // namespace lumibox::testing
