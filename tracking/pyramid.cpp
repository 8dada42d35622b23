#include "tracking/pyramid.h"

#include <algorithm>

namespace lumibox::tracking {
namespace {

void halve(const hal::Image& source, hal::Image& half) {
  if (half.width() != source.width() / 2 || half.height() != source.height() / 2) {
    half = hal::Image(source.width() / 2, source.height() / 2, 1);
  }
  for (int y = 0; y < half.height(); ++y) {
    const std::uint8_t* above = source.row(2 * y);
    const std::uint8_t* below = source.row(2 * y + 1);
    std::uint8_t* out = half.row(y);
    for (int x = 0; x < half.width(); ++x) {
      const int sum = above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1];
      out[x] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
}

}  // namespace

void Pyramid::assign(const hal::Image& gray, int levels) {
  int count = 1;
  for (int side = std::min(gray.width(), gray.height()); count < levels && side > 1; side /= 2) {
    ++count;
  }
  images_.resize(static_cast<std::size_t>(count));
  images_.front() = gray;
  for (std::size_t i = 1; i < images_.size(); ++i) halve(images_[i - 1], images_[i]);
}

std::shared_ptr<const Pyramid> PyramidPool::make(const hal::Image& gray, int levels) {
  auto free = std::ranges::find_if(pyramids_, [](const auto& p) { return p.use_count() == 1; });
  if (free == pyramids_.end()) {
    pyramids_.push_back(std::make_shared<Pyramid>());
    free = pyramids_.end() - 1;
  }
  // Taken before it is written to: libstdc++ counts references with acquire and release, so whoever
  // read it last, perhaps on another thread, is done.
  const std::shared_ptr<Pyramid> taken = *free;
  taken->assign(gray, levels);
  return taken;
}

}  // namespace lumibox::tracking
