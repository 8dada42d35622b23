#pragma once

#include <vector>

#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

/// The views that a lens as large as the wide aperture of `settings` adds up: from points of a disc
/// around the view's centre, perpendicular to its axis, that reaches as far as the perspectives
/// with a weight do, seen from S. The points lie as densely as the weights of thesis 3.2 would be
/// there, so that the views count alike. Each is turned as the view is, and its principal point is
/// moved so that the plane through S facing the view stays where it is in the picture.
///
/// `settings.aperture_views` of them, always the same; none if S does not lie before the view.
std::vector<View> aperture_views(const View& view,
                                 const std::vector<lightfield::Perspective>& perspectives,
                                 const Settings& settings);

/// How far from the middle of a disc of radius 1 a share of the weights (1 - r)^exponent on it lies
/// within.
double radius_of_share(double share, double exponent);

}  // namespace lumibox::render
