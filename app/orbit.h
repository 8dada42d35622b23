#pragma once

#include <optional>

#include "geometry/pose.h"
#include "lightfield/light_field.h"

namespace lumibox::app {

/// Where the automatic orbit of review has its virtual camera at `phase` (radians): on an ellipse
/// around the middle of the recorded perspectives, as wide and as high as they are spread, at their
/// mean distance, looking at S with the recorded cameras' mean up. None without a subject or
/// perspectives.
std::optional<geometry::Pose> orbit_pose(const lightfield::LightField& light_field, double phase);

}  // namespace lumibox::app
