#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "hal/image.h"
#include "hal/image_io.h"

/// One reader per file format, behind read_image(). `name` is what error messages call the file.
namespace lumibox::hal {

using Bytes = std::span<const std::uint8_t>;

bool is_jpeg(Bytes bytes);
ImageInfo read_jpeg_info(Bytes bytes, const std::filesystem::path& name);
// The pixels: decode_jpeg() in image_io.h.

bool is_png(Bytes bytes);
ImageInfo read_png_info(Bytes bytes, const std::filesystem::path& name);
Image decode_png(Bytes bytes, const std::filesystem::path& name);

bool is_pnm(Bytes bytes);
ImageInfo read_pnm_info(Bytes bytes, const std::filesystem::path& name);
Image decode_pnm(Bytes bytes, const std::filesystem::path& name);

/// A header may claim any size: refuses what no camera makes before memory is asked for.
void check_image_size(std::int64_t width, std::int64_t height, const std::filesystem::path& name);

}  // namespace lumibox::hal
