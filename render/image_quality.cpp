#include "render/image_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/robust.h"
#include "render/sampling.h"

namespace lumibox::render {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr int kCells = 10;           // across what is masked
constexpr double kPatchShare = 0.9;  // an occluder of a tenth of the subject counts

bool comparable(const hal::Image& a, const hal::Image& b, const hal::Image* mask) {
  const auto same_size = [](const hal::Image& x, const hal::Image& y) {
    return x.width() == y.width() && x.height() == y.height();
  };
  return same_size(a, b) && a.channels() == b.channels() && (!mask || same_size(a, *mask));
}

/// Rec. 601 luma, not rounded.
cv::Mat luma(const hal::Image& image) {
  cv::Mat result(image.height(), image.width(), CV_64F);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::uint8_t* p = image.at(x, y);
      result.at<double>(y, x) =
          image.channels() == 3 ? 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2] : p[0];
    }
  }
  return result;
}

cv::Mat local_mean(const cv::Mat& values) {
  cv::Mat result;
  cv::GaussianBlur(values, result, cv::Size(kWindow, kWindow), kSigma);
  return result;
}

/// Equation 13 of the paper at every pixel, for values 0..255.
cv::Mat ssim_map(const cv::Mat& x, const cv::Mat& y) {
  const double c1 = std::pow(0.01 * 255.0, 2);
  const double c2 = std::pow(0.03 * 255.0, 2);
  const cv::Mat mean_x = local_mean(x);
  const cv::Mat mean_y = local_mean(y);
  const cv::Mat variance_x = local_mean(x.mul(x)) - mean_x.mul(mean_x);
  const cv::Mat variance_y = local_mean(y.mul(y)) - mean_y.mul(mean_y);
  const cv::Mat covariance = local_mean(x.mul(y)) - mean_x.mul(mean_y);
  const cv::Mat above = (2.0 * mean_x.mul(mean_y) + c1).mul(2.0 * covariance + c2);
  const cv::Mat below =
      (mean_x.mul(mean_x) + mean_y.mul(mean_y) + c1).mul(variance_x + variance_y + c2);
  return above / below;
}

/// Luma of two pictures, one of them to be shifted against the other.
class MaskedPair {
 public:
  MaskedPair(const hal::Image& a, const hal::Image& b, const hal::Image& mask)
      : a_(luma(a)), b_(luma(b)), mask_(mask) {}

  /// Mean square of a(x, y) - b(x + dx, y + dy) where the mask and both pictures are; infinite if
  /// that is nowhere.
  double mean_square(int dx, int dy) const {
    double squares = 0.0;
    double count = 0.0;
    for (int y = std::max(0, -dy); y < std::min(a_.rows, a_.rows - dy); ++y) {
      for (int x = std::max(0, -dx); x < std::min(a_.cols, a_.cols - dx); ++x) {
        if (*mask_.at(x, y) == 0) continue;
        const double difference = a_.at<double>(y, x) - b_.at<double>(y + dy, x + dx);
        squares += difference * difference;
        count += 1.0;
      }
    }
    return count > 0.0 ? squares / count : std::numeric_limits<double>::infinity();
  }

 private:
  cv::Mat a_;
  cv::Mat b_;
  const hal::Image& mask_;
};

/// Where the parabola through values at -1, 0 and 1 is lowest, within half a step of 0; 0 if it has
/// no lowest point.
double lowest(double before, double at, double after) {
  const double curvature = before + after - 2.0 * at;
  if (!std::isfinite(curvature) || curvature <= 0.0) return 0.0;
  return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

/// Root mean square over the channels of the difference of mean in one cell; none if less than a
/// third of it is masked.
std::optional<double> mean_difference(const hal::Image& a, const hal::Image& b,
                                      const hal::Image& mask, int left, int top, int cell) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  int count = 0;
  for (int y = top; y < std::min(top + cell, mask.height()); ++y) {
    for (int x = left; x < std::min(left + cell, mask.width()); ++x) {
      if (*mask.at(x, y) == 0) continue;
      sum += (texel(a, x, y) - texel(b, x, y)).array();
      ++count;
    }
  }
  if (3 * count < cell * cell || count == 0) return std::nullopt;
  return std::sqrt((sum / count).square().mean());
}

}  // namespace

Box box_of(const hal::Image& mask) {
  Box box{mask.width(), mask.height(), -1, -1};
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if (*mask.at(x, y) == 0) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
             std::max(box.bottom, y)};
    }
  }
  return box;
}

double psnr(const hal::Image& a, const hal::Image& b, const hal::Image* mask) {
  if (!comparable(a, b, mask)) return kNothing;
  double squares = 0.0;
  double count = 0.0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      if (mask && *mask->at(x, y) == 0) continue;
      for (int c = 0; c < a.channels(); ++c) {
        const double difference = a.at(x, y)[c] - b.at(x, y)[c];
        squares += difference * difference;
        count += 1.0;
      }
    }
  }
  if (count == 0.0) return kNothing;
  if (squares == 0.0) return kMaxPsnr;
  return std::min(kMaxPsnr, 10.0 * std::log10(255.0 * 255.0 * count / squares));
}

double ssim(const hal::Image& a, const hal::Image& b, const hal::Image* mask) {
  if (!comparable(a, b, mask) || a.width() < kWindow || a.height() < kWindow) return kNothing;
  const cv::Mat map = ssim_map(luma(a), luma(b));
  constexpr int kMargin = kWindow / 2;
  double sum = 0.0;
  double count = 0.0;
  for (int y = kMargin; y < a.height() - kMargin; ++y) {
    for (int x = kMargin; x < a.width() - kMargin; ++x) {
      if (mask && *mask->at(x, y) == 0) continue;
      sum += map.at<double>(y, x);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : kNothing;
}

Eigen::Vector2d shift_between(const hal::Image& a, const hal::Image& b, const hal::Image& mask,
                              int reach) {
  if (!comparable(a, b, &mask)) return Eigen::Vector2d::Zero();
  const MaskedPair pair(a, b, mask);
  double best = std::numeric_limits<double>::infinity();
  int right = 0;
  int down = 0;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double cost = pair.mean_square(dx, dy);
      if (cost < best) {
        best = cost;
        right = dx;
        down = dy;
      }
    }
  }
  if (!std::isfinite(best)) return Eigen::Vector2d::Zero();
  return {
      right + lowest(pair.mean_square(right - 1, down), best, pair.mean_square(right + 1, down)),
      down + lowest(pair.mean_square(right, down - 1), best, pair.mean_square(right, down + 1))};
}

double patch_difference(const hal::Image& a, const hal::Image& b, const hal::Image& mask) {
  if (!comparable(a, b, &mask)) return kNothing;
  const Box box = box_of(mask);
  const int cell = std::max(2, (box.width() + box.height()) / (2 * kCells));
  std::vector<double> differences;
  for (int y = box.top; y <= box.bottom; y += cell) {
    for (int x = box.left; x <= box.right; x += cell) {
      if (const auto difference = mean_difference(a, b, mask, x, y, cell)) {
        differences.push_back(*difference);
      }
    }
  }
  return differences.empty() ? kNothing : geometry::quantile(std::move(differences), kPatchShare);
}

hal::Image subject_mask(const View& view, const lightfield::Sphere& sphere) {
  const config::CameraProfile& c = view.camera.profile();
  const Eigen::Vector3d center = view.world_from_camera.inverse() * sphere.center;
  const double outside2 = center.squaredNorm() - sphere.radius * sphere.radius;
  hal::Image mask(view.camera.width(), view.camera.height(), 1);
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const Eigen::Vector3d ray =
          Eigen::Vector3d((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1.0).normalized();
      const double along = ray.dot(center);
      // The ray comes as near to the centre as |center|^2 - along^2; inside, every ray hits.
      const bool hits = outside2 <= 0.0 || (along > 0.0 && along * along >= outside2);
      *mask.at(u, v) = hits ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace lumibox::render
