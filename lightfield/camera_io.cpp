#include "lightfield/camera_io.h"

#include <algorithm>
#include <tuple>

namespace lumibox::lightfield {
namespace {

auto lens(const config::CameraProfile& c) {
  return std::tie(c.model, c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3,
                  c.k4);
}

}  // namespace

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
