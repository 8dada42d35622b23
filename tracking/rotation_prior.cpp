#include "tracking/rotation_prior.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/rotation.h"
#include "tracking/opencv_view.h"

namespace lumibox::tracking {
namespace {

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

/// One Gauss-Newton step with the mean of both images' gradients; returns the RMS before it.
double step_once(const SmallImage& last, const SmallImage& current, Warp& warp, float& offset) {
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
  if (count < 64) return 1e9;
  const Eigen::Vector4d step = hessian.ldlt().solve(gradient);
  warp.dx -= step[0];
  warp.dy -= step[1];
  warp.angle -= step[2];
  offset -= static_cast<float>(step[3]);
  return std::sqrt(sum / count);
}

}  // namespace

SmallImage::SmallImage(const Pyramid& pyramid) {
  const int level = pyramid.levels() - 1;
  cv::Mat small = opencv_view(pyramid.level(level));
  scale_ = 1 << level;
  while (small.cols > 60) {
    cv::Mat half;
    cv::resize(small, half, cv::Size(small.cols / 2, small.rows / 2), 0, 0, cv::INTER_AREA);
    small = half;
    scale_ *= 2;
  }
  cv::Mat blurred;
  small.convertTo(blurred, CV_32F);
  cv::GaussianBlur(blurred, blurred, cv::Size(0, 0), 1.25);
  blurred -= cv::mean(blurred)[0];
  width_ = blurred.cols;
  height_ = blurred.rows;
  values_.assign(blurred.ptr<float>(), blurred.ptr<float>() + blurred.total());
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
  for (int iteration = 0; iteration < 12; ++iteration) {
    prior.residual = step_once(last, current, warp, offset);
    if (prior.residual > 1e8 || std::abs(warp.dx) > last.width() ||
        std::abs(warp.dy) > last.height()) {
      return {Eigen::Quaterniond::Identity(), 1e9};
    }
  }
  // The picture moves by (dx, dy) when rays turn by omega x z = (omega_y, -omega_x).
  const double focal = camera.profile().fx / last.scale();
  const Eigen::Vector3d omega(-std::atan(warp.dy / focal), std::atan(warp.dx / focal), warp.angle);
  prior.current_from_last = geometry::exp_so3(omega);
  return prior;
}

}  // namespace lumibox::tracking
