#include <turbojpeg.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "config/error.h"
#include "hal/image_codecs.h"
#include "hal/owned.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;

using Handle = std::unique_ptr<void, Freed<tjDestroy>>;

[[noreturn]] void throw_damaged(const Handle& handle, const fs::path& name) {
  throw config::InputError(name, std::string("damaged JPEG: ") + tjGetErrorStr2(handle.get()));
}

ImageInfo read_header(const Handle& handle, Bytes bytes, const fs::path& name) {
  ImageInfo info;
  int subsampling = 0;
  int colorspace = 0;
  if (tjDecompressHeader3(handle.get(), bytes.data(), bytes.size(), &info.width, &info.height,
                          &subsampling, &colorspace) != 0) {
    throw_damaged(handle, name);
  }
  if (colorspace == TJCS_CMYK || colorspace == TJCS_YCCK) {
    throw config::InputError(name, "JPEG in CMYK; expected grey or colour");
  }
  info.channels = colorspace == TJCS_GRAY ? 1 : 3;
  check_image_size(info.width, info.height, name);
  return info;
}

}  // namespace

bool is_jpeg(Bytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

ImageInfo read_jpeg_info(Bytes bytes, const fs::path& name) {
  const Handle handle(tjInitDecompress());
  return read_header(handle, bytes, name);
}

Image decode_jpeg(Bytes bytes, const fs::path& name) {
  const Handle handle(tjInitDecompress());
  const ImageInfo info = read_header(handle, bytes, name);
  Image image(info.width, info.height, info.channels);
  // libjpeg only warns of missing data and fills in grey; a progressive file of very many scans is
  // an attack on time.
  const int flags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT;
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), image.data(), info.width,
                    static_cast<int>(image.stride()), info.height,
                    info.channels == 1 ? TJPF_GRAY : TJPF_RGB, flags) != 0) {
    throw_damaged(handle, name);
  }
  return image;
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality) {
  const Handle handle(tjInitCompress());
  const bool gray = image.channels() == 1;
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const int status =
      tjCompress2(handle.get(), image.data(), image.width(), static_cast<int>(image.stride()),
                  image.height(), gray ? TJPF_GRAY : TJPF_RGB, &buffer, &size,
                  gray ? TJSAMP_GRAY : TJSAMP_420, quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, Freed<tjFree>> owner(buffer);
  if (status != 0) {
    throw std::invalid_argument(std::string("encode_jpeg: ") + tjGetErrorStr2(handle.get()));
  }
  return {buffer, buffer + size};
}

}  // namespace lumibox::hal
