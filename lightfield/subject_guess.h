#pragma once

#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// A sphere for a data set that names no subject. Its centre is the point nearest to all optical
/// axes in the least-squares sense. Where that point is not determined (axes parallel, one picture)
/// or not in front of most cameras (they look outwards), it lies before the middle of the cameras
/// at the median depth of `points`, or without points at a few times the cameras' spread.
Sphere guess_subject(const std::vector<Perspective>& perspectives,
                     const std::vector<Eigen::Vector3d>& points);

}  // namespace lumibox::lightfield
