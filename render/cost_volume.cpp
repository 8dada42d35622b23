#include "render/cost_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumibox::render {
namespace {

// Of colours from 0 to 1.
constexpr float kMaxDifference = 0.25F;  // larger ones say no more
constexpr float kUnseen = 0.15F;         // of a point that another picture does not show
constexpr float kStep = 0.018F;          // one depth from a pixel to the next
constexpr float kJump = 0.15F;           // more than one, where the colour stays
constexpr float kJumpAtEdge = 0.09F;     // where it changes
constexpr float kEdge = 0.05F;           // a change of colour that halves the former

float difference(const float* a, const float* b) {
  return (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2])) / 3.0F;
}

/// The other picture at a place given in the reference's pixels and inverse depth, as
/// before * (x, y, 1) + inverse depth * shift in homogeneous pixels.
struct Warp {
  Eigen::Matrix3f before;
  Eigen::Vector3f shift;

  Warp(const SmallPicture& from, const SmallPicture& to) {
    const geometry::Pose to_from_from = to.world_from_camera.inverse() * from.world_from_camera;
    before = (to.camera.pinhole_matrix() * to_from_from.matrix3() *
              from.camera.pinhole_matrix().inverse())
                 .cast<float>();
    shift = (to.camera.pinhole_matrix() * to_from_from.translation).cast<float>();
  }
};

float cost_at(const float* color, const SmallPicture& other, const Eigen::Vector3f& place) {
  if (!(place.z() > 0.0F)) return kUnseen;
  const float x = place.x() / place.z();
  const float y = place.y() / place.z();
  const auto right = static_cast<float>(other.width() - 1);
  const auto bottom = static_cast<float>(other.height() - 1);
  if (!(x >= 0.0F && y >= 0.0F && x < right && y < bottom)) return kUnseen;
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const float a = x - static_cast<float>(x0);
  const float b = y - static_cast<float>(y0);
  const float* above = other.at(x0, y0);
  const float* below = other.at(x0, y0 + 1);
  std::array<float, 3> sample;
  for (std::size_t c = 0; c < 3; ++c) {
    sample[c] = (1.0F - b) * ((1.0F - a) * above[c] + a * above[c + 3]) +
                b * ((1.0F - a) * below[c] + a * below[c + 3]);
  }
  return std::min(difference(color, sample.data()), kMaxDifference);
}

/// Mean of the smaller half.
float mean_of_better_half(std::vector<float>& costs) {
  const std::size_t half = (costs.size() + 1) / 2;
  std::nth_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(half) - 1,
                   costs.end());
  float sum = 0.0F;
  for (std::size_t i = 0; i < half; ++i) sum += costs[i];
  return sum / static_cast<float>(half);
}

}  // namespace

CostVolume::CostVolume(const SmallPicture& picture, const std::vector<const SmallPicture*>& others,
                       double nearest, int depths)
    : width_(picture.width()), height_(picture.height()), depths_(depths), nearest_(nearest) {
  costs_.assign(static_cast<std::size_t>(width_ * height_) * static_cast<std::size_t>(depths_),
                kUnseen);
  if (others.empty()) return;
  sweep(picture, others);
  smooth();
}

void CostVolume::sweep(const SmallPicture& picture,
                       const std::vector<const SmallPicture*>& others) {
  std::vector<Warp> warps;
  for (const SmallPicture* other : others) warps.emplace_back(picture, *other);
  std::vector<float> costs(others.size());
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector3f pixel(static_cast<float>(x), static_cast<float>(y), 1.0F);
      float* out = at(x, y);
      for (int d = 0; d < depths_; ++d) {
        const auto rho = static_cast<float>(inverse_depth(d));
        for (std::size_t i = 0; i < others.size(); ++i) {
          costs[i] =
              cost_at(picture.at(x, y), *others[i], warps[i].before * pixel + rho * warps[i].shift);
        }
        out[d] = mean_of_better_half(costs);
      }
    }
  }
}

void CostVolume::smooth() {
  const auto depths = static_cast<std::size_t>(depths_);
  std::vector<float> smoothed(costs_.size());
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      float* out = &smoothed[offset(x, y)];
      float count = 0.0F;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
          const float* in = at(u, v);
          for (std::size_t d = 0; d < depths; ++d) out[d] += in[d];
          count += 1.0F;
        }
      }
      for (std::size_t d = 0; d < depths; ++d) out[d] /= count;
    }
  }
  costs_ = std::move(smoothed);
}

/// Costs along parallel paths, each pixel from the one before, added to `sum`.
void CostVolume::add_paths(const SmallPicture& picture, int dx, int dy,
                           std::vector<float>& sum) const {
  std::vector<float> along(costs_.size());
  const auto depths = static_cast<std::size_t>(depths_);
  for (int j = 0; j < height_; ++j) {
    for (int i = 0; i < width_; ++i) {
      const int x = dx >= 0 ? i : width_ - 1 - i;
      const int y = dy >= 0 ? j : height_ - 1 - j;
      const float* own = at(x, y);
      float* out = &along[offset(x, y)];
      const int u = x - dx;
      const int v = y - dy;
      if (u < 0 || v < 0 || u >= width_ || v >= height_) {
        std::copy_n(own, depths, out);
      } else {
        const float* last = &along[offset(u, v)];
        const float least = *std::min_element(last, last + depths);
        const float edge = difference(picture.at(x, y), picture.at(u, v));
        const float jump = least + std::max(kJumpAtEdge, kJump / (1.0F + edge / kEdge));
        for (std::size_t d = 0; d < depths; ++d) {
          float best = std::min(last[d], jump);
          if (d > 0) best = std::min(best, last[d - 1] + kStep);
          if (d + 1 < depths) best = std::min(best, last[d + 1] + kStep);
          out[d] = own[d] + best - least;
        }
      }
      float* total = &sum[offset(x, y)];
      for (std::size_t d = 0; d < depths; ++d) total[d] += out[d];
    }
  }
}

CostVolume CostVolume::aggregated(const SmallPicture& picture) const {
  CostVolume result = *this;
  std::fill(result.costs_.begin(), result.costs_.end(), 0.0F);
  for (const auto& [dx, dy] :
       {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
    add_paths(picture, dx, dy, result.costs_);
  }
  return result;
}

}  // namespace lumibox::render
