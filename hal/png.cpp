#include <spng.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "config/error.h"
#include "config/output_file.h"
#include "hal/image_codecs.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

void check(int status, const fs::path& name) {
  if (status != SPNG_OK) {
    throw config::InputError(name, std::string("damaged PNG: ") + spng_strerror(status));
  }
}

Context open(Bytes bytes, const fs::path& name) {
  Context context(spng_ctx_new(0));
  check(spng_set_crc_action(context.get(), SPNG_CRC_ERROR, SPNG_CRC_ERROR), name);
  // Text and colour profiles are skipped by us, but stored by the library: not without bound.
  constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 26;
  check(spng_set_chunk_limits(context.get(), kMaxChunkBytes, kMaxChunkBytes), name);
  check(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()), name);
  return context;
}

ImageInfo read_header(const Context& context, const fs::path& name) {
  spng_ihdr header{};
  check(spng_get_ihdr(context.get(), &header), name);
  check_image_size(header.width, header.height, name);
  const bool gray = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
                    header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
  return {static_cast<int>(header.width), static_cast<int>(header.height), gray ? 1 : 3};
}

/// True if the file holds a whole end chunk; the library does not ask for the last of its bytes.
bool has_end(Bytes bytes) {
  constexpr std::uint8_t kEnd[] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
  return std::ranges::find_end(bytes, kEnd).size() == sizeof kEnd;
}

}  // namespace

bool is_png(Bytes bytes) {
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  return bytes.size() >= sizeof kSignature &&
         std::memcmp(bytes.data(), kSignature, sizeof kSignature) == 0;
}

ImageInfo read_png_info(Bytes bytes, const fs::path& name) {
  return read_header(open(bytes, name), name);
}

Image decode_png(Bytes bytes, const fs::path& name) {
  const Context context = open(bytes, name);
  const ImageInfo info = read_header(context, name);
  // RGB8 is the one format that the library makes of every kind of PNG.
  Image color(info.width, info.height, 3);
  check(spng_decode_image(context.get(), color.data(), color.size_bytes(), SPNG_FMT_RGB8, 0), name);
  check(spng_decode_chunks(context.get()), name);
  if (!has_end(bytes)) {
    throw config::InputError(name, "damaged PNG: cut before its end");
  }
  if (info.channels == 3) {
    return color;
  }
  Image gray(info.width, info.height, 1);
  for (std::size_t i = 0; i < gray.size_bytes(); ++i) {
    gray.data()[i] = color.data()[3 * i];
  }
  return gray;
}

std::vector<std::uint8_t> encode_png(const Image& image) {
  const fs::path nowhere = "PNG in memory";
  const Context context(spng_ctx_new(SPNG_CTX_ENCODER));
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(image.width());
  header.height = static_cast<std::uint32_t>(image.height());
  header.bit_depth = 8;
  header.color_type = image.channels() == 1 ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR;
  check(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1), nowhere);
  // Level 3 takes a fraction of the default's time for a few per cent in size.
  check(spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, 3), nowhere);
  check(spng_set_ihdr(context.get(), &header), nowhere);
  check(spng_encode_image(context.get(), image.data(), image.size_bytes(), SPNG_FMT_PNG,
                          SPNG_ENCODE_FINALIZE),
        nowhere);
  std::size_t size = 0;
  int status = SPNG_OK;
  const std::unique_ptr<void, decltype(&std::free)> png(
      spng_get_png_buffer(context.get(), &size, &status), &std::free);
  check(status, nowhere);
  const auto* bytes = static_cast<const std::uint8_t*>(png.get());
  return {bytes, bytes + size};
}

void write_png(const fs::path& path, const Image& image) {
  config::write_bytes(path, encode_png(image));
}

}  // namespace lumibox::hal
