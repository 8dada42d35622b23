#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lightfield/perspective.h"
#include "render/strokes.h"
#include "render/view.h"

namespace lumibox::render {

/// The coverage map of thesis 2.3 as seen from a view: circles of latitude and longitude about the
/// world's y axis, the sphere's outline, a dot per recorded centre in the colour of its quality,
/// with a ring if it disagrees, a red one for the current, and an arrow from there to the hole.
/// What lies on the far side is dimmer; what lies behind the view is left out.
Strokes coverage_map(const Coverage& coverage, const View& view);

}  // namespace lumibox::render
