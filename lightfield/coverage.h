#pragma once

#include <Eigen/Core>
#include <optional>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// The dot of a perspective on the coverage map (thesis 2.3, figure 2.3): where the line from its
/// centre to S meets the sphere, on the centre's side. None for a centre at S.
std::optional<Eigen::Vector3d> dot_on_sphere(const Sphere& sphere, const Eigen::Vector3d& center);

}  // namespace lumibox::lightfield
