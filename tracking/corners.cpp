#include "tracking/corners.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

#include "tracking/opencv_view.h"

namespace lumibox::tracking {
namespace {

constexpr int kCell = 16;           // pixels of the level; one corner per cell
constexpr int kBorder = 8;          // pixels of the level; leaves room for patch and gradient
constexpr float kMinScore = 12.0F;  // below this a patch cannot be located across an edge
// Where that leaves most of the picture empty (a plain floor, a white wall), weaker corners are
// better than none: down to what stands out of a webcam's noise.
constexpr double kEmptyShare = 0.5;  // of the corners wanted
constexpr int kWeakDivisor = 3;      // of the FAST threshold
constexpr float kWeakScore = 2.0F;

float shi_tomasi_score(const hal::Image& image, int x, int y) {
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
  for (int v = y - 3; v <= y + 3; ++v) {
    const std::uint8_t* above = image.row(v - 1);
    const std::uint8_t* here = image.row(v);
    const std::uint8_t* below = image.row(v + 1);
    for (int u = x - 3; u <= x + 3; ++u) {
      const float gx = 0.5F * static_cast<float>(here[u + 1] - here[u - 1]);
      const float gy = 0.5F * static_cast<float>(below[u] - above[u]);
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  }
  const float half_trace = 0.5F * (xx + yy);
  const float half_gap = 0.5F * (xx - yy);
  return (half_trace - std::sqrt(half_gap * half_gap + xy * xy)) / 49.0F;
}

void detect_on_level(const hal::Image& image, int level, int fast_threshold, float min_score,
                     std::vector<Corner>& corners) {
  if (image.width() <= 2 * kBorder || image.height() <= 2 * kBorder) return;
  const cv::Mat view = opencv_view(image);
  std::vector<cv::KeyPoint> candidates;
  cv::FAST(view, candidates, fast_threshold, true);

  const int columns = (image.width() + kCell - 1) / kCell;
  const int rows = (image.height() + kCell - 1) / kCell;
  std::vector<Corner> best(static_cast<std::size_t>(columns * rows));
  for (const cv::KeyPoint& candidate : candidates) {
    const int x = static_cast<int>(candidate.pt.x);
    const int y = static_cast<int>(candidate.pt.y);
    if (x < kBorder || y < kBorder || x >= image.width() - kBorder ||
        y >= image.height() - kBorder) {
      continue;
    }
    Corner& cell = best[static_cast<std::size_t>((y / kCell) * columns + x / kCell)];
    const float score = shi_tomasi_score(image, x, y);
    if (score > cell.score && score > min_score) cell = {Eigen::Vector2d(x, y), level, score};
  }
  std::copy_if(best.begin(), best.end(), std::back_inserter(corners),
               [](const Corner& corner) { return corner.score > 0.0F; });
}

std::vector<Corner> detect_on_levels(const Pyramid& pyramid, int fast_threshold, float min_score) {
  std::vector<Corner> corners;
  for (int level = 0; level < pyramid.levels(); ++level) {
    detect_on_level(pyramid.level(level), level, fast_threshold, min_score, corners);
  }
  return corners;
}

}  // namespace

std::vector<Corner> detect_corners(const Pyramid& pyramid, int fast_threshold, int max_count) {
  std::vector<Corner> corners = detect_on_levels(pyramid, fast_threshold, kMinScore);
  if (static_cast<double>(corners.size()) < kEmptyShare * max_count) {
    corners = detect_on_levels(pyramid, std::max(1, fast_threshold / kWeakDivisor), kWeakScore);
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.score > b.score; });
  if (corners.size() > static_cast<std::size_t>(max_count)) {
    corners.resize(static_cast<std::size_t>(max_count));
  }
  return corners;
}

}  // namespace lumibox::tracking
