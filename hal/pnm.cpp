#include <algorithm>
#include <cctype>
#include <string>

#include "config/error.h"
#include "hal/image_codecs.h"

// Binary PGM and PPM (http://netpbm.sourceforge.net/doc/pgm.html) with 8 bits per channel.
namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;

class HeaderReader {
 public:
  HeaderReader(Bytes bytes, const fs::path& name) : bytes_(bytes), name_(name) {}

  /// The next decimal number, after white space and comments.
  std::int64_t number() {
    skip_space_and_comments();
    constexpr int kMaxDigits = 9;
    std::int64_t value = 0;
    int digits = 0;
    for (; digits <= kMaxDigits && at_digit(); ++position_, ++digits) {
      value = value * 10 + (bytes_[position_] - '0');
    }
    if (digits == 0 || digits > kMaxDigits) {
      throw config::InputError(name_, "damaged PGM/PPM header; expected width, height, 255");
    }
    return value;
  }

  /// Offset of the first pixel: one byte of white space after the last number.
  std::size_t pixels() const { return position_ + 1; }

 private:
  bool at_digit() const {
    return position_ < bytes_.size() && std::isdigit(bytes_[position_]) != 0;
  }

  void skip_space_and_comments() {
    bool comment = false;
    for (; position_ < bytes_.size(); ++position_) {
      const std::uint8_t c = bytes_[position_];
      if (c == '#') comment = true;
      if (!comment && std::isspace(c) == 0) return;
      if (c == '\n') comment = false;
    }
  }

  Bytes bytes_;
  const fs::path& name_;
  std::size_t position_ = 2;  ///< after the magic number
};

struct Header {
  ImageInfo info;
  std::size_t pixels = 0;
};

Header read_header(Bytes bytes, const fs::path& name) {
  HeaderReader reader(bytes, name);
  const std::int64_t width = reader.number();
  const std::int64_t height = reader.number();
  check_image_size(width, height, name);
  const std::int64_t max_value = reader.number();
  if (max_value != 255) {
    throw config::InputError(
        name, "PGM/PPM with a largest value of " + std::to_string(max_value) + "; expected 255");
  }
  const int channels = bytes[1] == '5' ? 1 : 3;
  return {{static_cast<int>(width), static_cast<int>(height), channels}, reader.pixels()};
}

}  // namespace

bool is_pnm(Bytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 'P' && (bytes[1] == '5' || bytes[1] == '6') &&
         std::isspace(bytes[2]) != 0;
}

ImageInfo read_pnm_info(Bytes bytes, const fs::path& name) {
  return read_header(bytes, name).info;
}

Image decode_pnm(Bytes bytes, const fs::path& name) {
  const Header header = read_header(bytes, name);
  Image image(header.info.width, header.info.height, header.info.channels);
  const std::size_t available = bytes.size() - std::min(header.pixels, bytes.size());
  if (available < image.size_bytes()) {
    throw config::InputError(name, "damaged PGM/PPM: " + std::to_string(available) +
                                       " bytes of pixels; expected " +
                                       std::to_string(image.size_bytes()));
  }
  std::copy_n(bytes.data() + header.pixels, image.size_bytes(), image.data());
  return image;
}

}  // namespace lumibox::hal
