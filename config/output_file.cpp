#include "config/output_file.h"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "config/error.h"
#include "config/error_text.h"

namespace lumibox::config {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void fail(const fs::path& file, int error) {
  throw InputError(file, "cannot be written: " + error_text(error));
}

/// Not a device, and not what a link to it is called.
void remove_cut(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored)) fs::remove(fs::canonical(file, ignored), ignored);
}

}  // namespace

void write_bytes(const fs::path& file, std::span<const std::uint8_t> bytes) {
  std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "wb"));
  if (!stream) fail(file, errno);
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size() ||
      std::fclose(stream.release()) != 0) {
    const int error = errno;
    remove_cut(file);
    fail(file, error);
  }
}

void write_text(const fs::path& file, std::string_view text) {
  write_bytes(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace lumibox::config
