#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "hal/image.h"

namespace lumibox::hal {

/// Reads a JPEG, PNG or PGM/PPM file, told apart by content. Grey files give one channel, all
/// others three (alpha is dropped). A file that is missing, of another kind, truncated or damaged
/// throws config::InputError with the path: a damaged picture is never returned as a grey patch.
Image read_image(const std::filesystem::path& path);

/// Width, height and channels from the header alone; the pixels are not decoded.
/// Errors as read_image.
struct ImageInfo {
  int width = 0;
  int height = 0;
  int channels = 0;
};
ImageInfo read_image_info(const std::filesystem::path& path);

/// JPEG bytes of a picture; quality 1..100, 4:2:0 chroma.
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

/// Picture of JPEG bytes; `name` is what error messages call it.
Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::filesystem::path& name);

/// PNG bytes of a picture: lossless.
std::vector<std::uint8_t> encode_png(const Image& image);

/// Writes encode_png(). Throws config::InputError if the file cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace lumibox::hal
