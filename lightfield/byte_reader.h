#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>

#include "config/error.h"

namespace lumibox::lightfield {

/// Reads a binary file's bytes one value after the other (little endian, as this machine) and
/// throws config::InputError that names the file where they end too early.
class ByteReader {
 public:
  ByteReader(std::span<const std::uint8_t> bytes, std::filesystem::path file)
      : bytes_(bytes), file_(std::move(file)) {}

  template <typename T>
  T read() {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }

  /// Text up to `end`, which is not returned.
  std::string read_until(char end) {
    std::string text;
    for (char c = read<char>(); c != end; c = read<char>()) text += c;
    return text;
  }

  /// Skips `count` records; the check cannot overflow whatever the count.
  void skip(std::uint64_t count, std::size_t record_bytes) {
    if (count > bytes_.size() / record_bytes) fail_truncated();
    take(static_cast<std::size_t>(count) * record_bytes);
  }

  bool at_end() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }
  const std::filesystem::path& file() const { return file_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw config::InputError(file_, message);
  }

 private:
  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > bytes_.size()) fail_truncated();
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  [[noreturn]] void fail_truncated() const { fail("is truncated: ends in the middle of a record"); }

  std::span<const std::uint8_t> bytes_;
  std::filesystem::path file_;
};

}  // namespace lumibox::lightfield
