#include "hal/image_io.h"

#include <string>

#include "config/error.h"
#include "config/input_file.h"
#include "hal/image_codecs.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxSide = 1 << 14;
constexpr std::int64_t kMaxPixels = 1 << 26;

std::vector<std::uint8_t> read_file(const fs::path& path) {
  std::vector<std::uint8_t> bytes = config::read_bytes(path);
  if (bytes.empty()) {
    throw config::InputError(path, "empty file; expected an image");
  }
  return bytes;
}

[[noreturn]] void throw_unknown_format(const fs::path& path) {
  throw config::InputError(path, "not an image; expected JPEG, PNG, PGM (P5) or PPM (P6)");
}

}  // namespace

void check_image_size(std::int64_t width, std::int64_t height, const fs::path& name) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide ||
      width * height > kMaxPixels) {
    throw config::InputError(name, "image of " + std::to_string(width) + "x" +
                                       std::to_string(height) + " pixels; expected at most " +
                                       std::to_string(kMaxSide) + " a side and " +
                                       std::to_string(kMaxPixels) + " in all");
  }
}

Image read_image(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, path);
  if (is_png(bytes)) return decode_png(bytes, path);
  if (is_pnm(bytes)) return decode_pnm(bytes, path);
  throw_unknown_format(path);
}

ImageInfo read_image_info(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  if (is_jpeg(bytes)) return read_jpeg_info(bytes, path);
  if (is_png(bytes)) return read_png_info(bytes, path);
  if (is_pnm(bytes)) return read_pnm_info(bytes, path);
  throw_unknown_format(path);
}

}  // namespace lumibox::hal
