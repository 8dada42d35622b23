#pragma once

#include <optional>
#include <vector>

#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

/// Step of the autofocus's sweep, in inverse depths of S from the view. Half of it displaces
/// pictures taken five degrees apart by a pixel of 640x480.
inline constexpr double kFocusStep = 0.05;

/// Depth along the view's optical axis, in world units, of what is seen in the middle of the view:
/// where the pictures that the wide aperture blends agree best in a small window, from a third of
/// the way to `settings.focus` to twenty times as far. None if nothing there tells: no texture,
/// fewer than two pictures, the focus behind the view, or what is seen lies nearer.
std::optional<double> autofocus(const View& view,
                                const std::vector<lightfield::Perspective>& perspectives,
                                const Settings& settings);

}  // namespace lumibox::render
