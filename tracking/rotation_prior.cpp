#include "tracking/rotation_prior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/rotation.h"

namespace lumibox::tracking {
namespace {

constexpr int kMaxWidth = 60;      // pixels of the small image
constexpr float kSigma = 1.25F;    // of its blur, pixels
constexpr int kReach = 4;          // of the blur: beyond three sigmas there is nothing
constexpr int kIterations = 12;    // at most
constexpr double kSettled = 0.01;  // pixels of the small image: finer than a prior has to be

struct Warp {  // current pixel of a pixel (x, y) of the last image, about the image centre
  double dx = 0.0, dy = 0.0, angle = 0.0;
};

bool sample(const SmallImage& image, double x, double y, float* value, Eigen::Vector2f* gradient) {
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  if (x0 < 1 || y0 < 1 || x0 >= image.width() - 2 || y0 >= image.height() - 2) return false;
  const float ax = static_cast<float>(x - x0);
  const float ay = static_cast<float>(y - y0);
  const auto lerp = [&](int u, int v) {
    const float top = image.at(u, v) + ax * (image.at(u + 1, v) - image.at(u, v));
    const float bottom = image.at(u, v + 1) + ax * (image.at(u + 1, v + 1) - image.at(u, v + 1));
    return top + ay * (bottom - top);
  };
  *value = lerp(x0, y0);
  gradient->x() = 0.5F * (lerp(x0 + 1, y0) - lerp(x0 - 1, y0));
  gradient->y() = 0.5F * (lerp(x0, y0 + 1) - lerp(x0, y0 - 1));
  return true;
}

struct Step {
  double residual = 1e9;  ///< root mean square before it; 1e9 if too little overlaps
  double length = 0.0;    ///< pixels, at the image's edge
};

/// One Gauss-Newton step with the mean of both images' gradients.
Step step_once(const SmallImage& last, const SmallImage& current, Warp& warp, float& offset) {
  const double cx = 0.5 * (last.width() - 1);
  const double cy = 0.5 * (last.height() - 1);
  const double c = std::cos(warp.angle);
  const double s = std::sin(warp.angle);
  Eigen::Matrix4d hessian = Eigen::Matrix4d::Identity() * 1e-6;
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  double sum = 0.0;
  int count = 0;
  for (int y = 1; y < last.height() - 1; ++y) {
    for (int x = 1; x < last.width() - 1; ++x) {
      const double u = x - cx;
      const double v = y - cy;
      const double tu = c * u - s * v;
      const double tv = s * u + c * v;
      float value = 0.0F;
      Eigen::Vector2f slope;
      if (!sample(current, tu + cx + warp.dx, tv + cy + warp.dy, &value, &slope)) continue;
      const float gx = 0.5F * (last.at(x + 1, y) - last.at(x - 1, y));
      const float gy = 0.5F * (last.at(x, y + 1) - last.at(x, y - 1));
      const Eigen::Vector2d mean(0.5 * (static_cast<double>(slope.x()) +
                                        c * static_cast<double>(gx) - s * static_cast<double>(gy)),
                                 0.5 * (static_cast<double>(slope.y()) +
                                        s * static_cast<double>(gx) + c * static_cast<double>(gy)));
      const Eigen::Vector4d j(mean.x(), mean.y(), -mean.x() * tv + mean.y() * tu, 1.0);
      const double error = static_cast<double>(value + offset - last.at(x, y));
      hessian.noalias() += j * j.transpose();
      gradient.noalias() += j * error;
      sum += error * error;
      ++count;
    }
  }
  if (count < 64) return {};
  const Eigen::Vector4d step = hessian.ldlt().solve(gradient);
  warp.dx -= step[0];
  warp.dy -= step[1];
  warp.angle -= step[2];
  offset -= static_cast<float>(step[3]);
  return {std::sqrt(sum / count), std::abs(step[0]) + std::abs(step[1]) + cx * std::abs(step[2])};
}

}  // namespace

void SmallImage::assign(const Pyramid& pyramid) {
  const int level = pyramid.levels() - 1;
  const hal::Image& image = pyramid.level(level);
  int block = 1;
  while (image.width() / block > kMaxWidth) block *= 2;
  width_ = image.width() / block;
  height_ = image.height() / block;
  scale_ = block << level;
  values_.resize(static_cast<std::size_t>(width_ * height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      int sum = 0;
      for (int v = 0; v < block; ++v) {
        const std::uint8_t* row = image.row(y * block + v) + x * block;
        for (int u = 0; u < block; ++u) sum += row[u];
      }
      values_[static_cast<std::size_t>(y * width_ + x)] =
          static_cast<float>(sum) / static_cast<float>(block * block);
    }
  }
  blur();
  double sum = 0.0;
  for (const float v : values_) sum += static_cast<double>(v);
  const float mean =
      values_.empty() ? 0.0F : static_cast<float>(sum / static_cast<double>(values_.size()));
  for (float& v : values_) v -= mean;
}

/// A Gaussian in both directions, one after the other; what lies beyond the border is its mirror
/// image.
void SmallImage::blur() {
  std::array<float, 2 * kReach + 1> kernel;
  float total = 0.0F;
  for (int i = -kReach; i <= kReach; ++i) {
    const float weight = std::exp(-0.5F * static_cast<float>(i * i) / (kSigma * kSigma));
    kernel[static_cast<std::size_t>(i + kReach)] = weight;
    total += weight;
  }
  for (float& weight : kernel) weight /= total;
  const auto mirrored = [](int i, int size) {
    i = std::abs(i);
    return std::clamp(i < size ? i : 2 * size - 2 - i, 0, size - 1);
  };
  blurred_.resize(values_.size());
  const auto pass = [&](const std::vector<float>& from, std::vector<float>& to, int dx, int dy) {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        float sum = 0.0F;
        for (int i = -kReach; i <= kReach; ++i) {
          const int u = mirrored(x + i * dx, width_);
          const int v = mirrored(y + i * dy, height_);
          sum += kernel[static_cast<std::size_t>(i + kReach)] *
                 from[static_cast<std::size_t>(v * width_ + u)];
        }
        to[static_cast<std::size_t>(y * width_ + x)] = sum;
      }
    }
  };
  pass(values_, blurred_, 1, 0);
  pass(blurred_, values_, 0, 1);
}

double SmallImage::contrast() const {
  double sum = 0.0;
  for (const float v : values_) sum += static_cast<double>(v) * static_cast<double>(v);
  return values_.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values_.size()));
}

RotationPrior estimate_rotation(const geometry::Camera& camera, const SmallImage& last,
                                const SmallImage& current) {
  RotationPrior prior;
  Warp warp;
  float offset = 0.0F;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Step step = step_once(last, current, warp, offset);
    prior.residual = step.residual;
    if (prior.residual > 1e8 || std::abs(warp.dx) > last.width() ||
        std::abs(warp.dy) > last.height()) {
      return {Eigen::Quaterniond::Identity(), 1e9};
    }
    if (step.length < kSettled) break;
  }
  // The picture moves by (dx, dy) when rays turn by omega x z = (omega_y, -omega_x).
  const double focal = camera.profile().fx / last.scale();
  const Eigen::Vector3d omega(-std::atan(warp.dy / focal), std::atan(warp.dx / focal), warp.angle);
  prior.current_from_last = geometry::exp_so3(omega);
  return prior;
}

}  // namespace lumibox::tracking
