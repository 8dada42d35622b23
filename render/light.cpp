#include "render/light.h"

#include <algorithm>
#include <cmath>

namespace lumibox::render {

double light_of(double stored) {
  const double value = stored / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

Eigen::Vector3d light_of(const Eigen::Vector3d& stored) {
  return {light_of(stored.x()), light_of(stored.y()), light_of(stored.z())};
}

double stored_of(double light) {
  light = std::clamp(light, 0.0, 1.0);
  const double value =
      light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
  return 255.0 * value;
}

}  // namespace lumibox::render
