#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <vector>

#include "hal/sim/color.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Irradiance / pi that a surface point gets from the lights whose shadows are not traced per
/// frame: with the shadows of the scene as it stands where they are baked, without any where there
/// are none. Evaluated once per vertex when a scene is loaded.
Color baked_light(RTCScene scene, const std::vector<LightSpec>& lights,
                  const Eigen::Vector3f& point, const Eigen::Vector3f& normal);

/// What a light sends to a point that it reaches unhindered.
struct Incoming {
  Eigen::Vector3f towards_light = Eigen::Vector3f::UnitZ();  ///< unit
  float distance = 0.0f;  ///< metres; infinite for directional light
  Color color = Color::Zero();
};
Incoming incoming_light(const LightSpec& light, const Eigen::Vector3f& point);

}  // namespace lumibox::hal::sim
