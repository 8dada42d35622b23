#include "config/input_file.h"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "config/error.h"
#include "config/error_text.h"

namespace lumibox::config {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30U;

std::uintmax_t checked_size(const fs::path& file) {
  if (const auto fault = fault_of_file(file)) throw InputError(file, *fault);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(file, "cannot be read: " + error.message());
  if (size > kMostBytes) {
    throw InputError(
        file, std::to_string(size) + " bytes; expected at most " + std::to_string(kMostBytes));
  }
  return size;
}

template <typename Bytes>
Bytes read_all(const fs::path& file) {
  Bytes bytes;
  bytes.resize(checked_size(file));
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw InputError(file, "cannot be read: " + error_text(errno));
  return bytes;
}

}  // namespace

std::optional<std::string> fault_of_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return "no such file";
  if (error) return "cannot be read: " + error.message();
  if (fs::is_directory(status)) return "a folder, not a file";
  if (!fs::is_regular_file(status)) return "not a file";
  return std::nullopt;
}

std::vector<std::uint8_t> read_bytes(const fs::path& file) {
  return read_all<std::vector<std::uint8_t>>(file);
}

std::string read_text(const fs::path& file) {
  return read_all<std::string>(file);
}

}  // namespace lumibox::config
