#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lightfield/perspective.h"
#include "render/strokes.h"
#include "render/view.h"

namespace lumibox::render {

/// The coverage map of thesis 2.3 as seen from a view: circles of latitude and longitude about the
/// world's y axis, the sphere's outline, a white dot per recorded centre, a red one for the
/// current. What lies on the far side is dimmer; what lies behind the view is left out.
Strokes coverage_map(const lightfield::Sphere& sphere, const std::vector<Eigen::Vector3d>& recorded,
                     const std::optional<Eigen::Vector3d>& current, const View& view);

}  // namespace lumibox::render
