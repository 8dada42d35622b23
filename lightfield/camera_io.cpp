#include "lightfield/camera_io.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lumibox::lightfield {
namespace {

auto lens(const config::CameraProfile& c) {
  return std::tie(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3);
}

}  // namespace

std::string flaw(const config::CameraProfile& c) {
  constexpr int kLargestSide = 65535;  // of a JPEG
  if (c.width < 1 || c.height < 1 || c.width > kLargestSide || c.height > kLargestSide) {
    return "image size " + std::to_string(c.width) + "x" + std::to_string(c.height) +
           ", expected 1 to " + std::to_string(kLargestSide);
  }
  for (const double value : {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3}) {
    if (!std::isfinite(value)) return "a parameter that is not finite";
  }
  if (c.fx <= 0.0 || c.fy <= 0.0) return "a focal length that is not positive";
  return "";
}

bool same_lens(const config::CameraProfile& a, const config::CameraProfile& b) {
  return lens(a) == lens(b);
}

std::shared_ptr<const geometry::Camera> CameraPool::get(const config::CameraProfile& profile) {
  const auto known = std::find_if(cameras_.begin(), cameras_.end(), [&](const auto& camera) {
    return same_lens(camera->profile(), profile);
  });
  if (known != cameras_.end()) return *known;
  cameras_.push_back(std::make_shared<const geometry::Camera>(profile));
  return cameras_.back();
}

}  // namespace lumibox::lightfield
