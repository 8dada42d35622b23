#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "geometry/camera.h"

namespace lumibox::lightfield {

/// Pixel of the first pixel's centre in nerfstudio, instant-ngp and COLMAP, whose coordinates begin
/// at the picture's corner; ours is 0.
inline constexpr double kForeignPixelCentre = 0.5;

/// True if size and lens are the same; rate and readout do not matter to a still picture.
bool same_lens(const config::CameraProfile& a, const config::CameraProfile& b);

/// Gives equal profiles the same camera.
class CameraPool {
 public:
  std::shared_ptr<const geometry::Camera> get(const config::CameraProfile& profile);

 private:
  std::vector<std::shared_ptr<const geometry::Camera>> cameras_;
};

}  // namespace lumibox::lightfield
