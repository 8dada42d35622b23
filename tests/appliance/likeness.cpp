#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "appliance/box.h"

namespace lumibox::testing {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr int kBlock = 8;  // compared are means of blocks: the screen's colours went through YUV
// Between the lines of writing at the top and at the bottom.
constexpr int kFirstRow = 64, kEndRow = 400;

/// Mean luma, 0 to 255, of the blocks between the rows above.
template <typename Luma>
std::vector<double> blocks(Luma luma) {
  std::vector<double> out;
  for (int y = kFirstRow; y < kEndRow; y += kBlock) {
    for (int x = 0; x < kWidth; x += kBlock) {
      double sum = 0.0;
      for (int i = 0; i < kBlock * kBlock; ++i) sum += luma(x + i % kBlock, y + i / kBlock);
      out.push_back(sum / (kBlock * kBlock));
    }
  }
  return out;
}

double psnr(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 1e-9;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / squares);
}

}  // namespace

Likeness likeness_to_film(const hal::Image& screen) {
  if (screen.width() != kWidth || screen.height() != kHeight) {
    throw std::runtime_error("the screen is not 640x480");
  }
  const auto shown = blocks([&](int x, int y) {
    const auto* rgb = screen.at(x, y);
    return 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
  });
  std::ifstream film(image_folder() / "tools" / "film.yuyv", std::ios::binary);
  std::vector<char> picture(std::size_t{2} * kWidth * kHeight);
  std::vector<double> likenesses;
  while (film.read(picture.data(), static_cast<std::streamsize>(picture.size()))) {
    likenesses.push_back(psnr(
        shown, blocks([&](int x, int y) {
          const auto luma = static_cast<unsigned char>(
              picture[2 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x))]);
          return (luma - 16.0) * 255.0 / 219.0;
        })));
  }
  if (likenesses.empty()) throw std::runtime_error("there is no film");
  std::sort(likenesses.begin(), likenesses.end());
  return {likenesses.back(), likenesses[likenesses.size() / 2]};
}

}  // namespace lumibox::testing
