#include "render/reduced.h"

#include <memory>
#include <utility>

namespace lumibox::render {
namespace {

hal::Image halved(const hal::Image& image) {
  hal::Image half(image.width() / 2, image.height() / 2, 3);
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const int sum = image.at(2 * x, 2 * y)[c] + image.at(2 * x + 1, 2 * y)[c] +
                        image.at(2 * x, 2 * y + 1)[c] + image.at(2 * x + 1, 2 * y + 1)[c];
        half.at(x, y)[c] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace

std::optional<lightfield::Perspective> reduced(const lightfield::Perspective& perspective,
                                               int max_pixels) {
  std::shared_ptr<const hal::Image> pixels = perspective.photo->rgb();
  if (!pixels) return std::nullopt;
  int level = 0;
  while (pixels->width() * pixels->height() > max_pixels) {
    pixels = std::make_shared<const hal::Image>(halved(*pixels));
    ++level;
  }
  lightfield::Perspective small = perspective;
  small.photo = std::make_shared<lightfield::Photo>(std::move(pixels));
  if (level > 0) {
    small.camera = std::make_shared<const geometry::Camera>(perspective.camera->at_level(level));
  }
  return small;
}

}  // namespace lumibox::render
