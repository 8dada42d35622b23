#include "tracking/pyramid.h"

namespace lumibox::tracking {
namespace {

hal::Image halve(const hal::Image& source) {
  hal::Image half(source.width() / 2, source.height() / 2, 1);
  for (int y = 0; y < half.height(); ++y) {
    const std::uint8_t* above = source.row(2 * y);
    const std::uint8_t* below = source.row(2 * y + 1);
    std::uint8_t* out = half.row(y);
    for (int x = 0; x < half.width(); ++x) {
      const int sum = above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1];
      out[x] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
  return half;
}

}  // namespace

Pyramid::Pyramid(const hal::Image& gray, int levels) {
  images_.reserve(static_cast<std::size_t>(levels));
  images_.push_back(gray);
  while (this->levels() < levels && images_.back().width() > 1 && images_.back().height() > 1) {
    images_.push_back(halve(images_.back()));
  }
}

}  // namespace lumibox::tracking
