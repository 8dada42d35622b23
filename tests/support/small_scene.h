#pragma once

namespace lumibox::testing {

/// A scene file of a ball on a patterned floor, seen in small pictures along an arc of 60 degrees:
/// quickly rendered.
inline constexpr const char* kSmallScene = R"(
duration_s = 2.0
background = [0.2, 0.3, 0.4]
subject = { center = [0.0, 0.0, 0.1], radius_m = 0.15 }
camera = { width = 48, height = 36, fx = 42.0, fps = 30.0 }
lights = [{ kind = "ambient" }]
[path.orbit]
target = [0.0, 0.0, 0.1]
azimuth_deg = [-30.0, 30.0]
elevation_deg = [20.0, 20.0]
radius_m = [0.6, 0.6]
[[textures]]
name = "poster"
pattern = "poster"
texels = [64, 64]
cell_m = 0.05
palette = [[0.8, 0.8, 0.7], [0.2, 0.3, 0.6], [0.7, 0.2, 0.2]]
[[objects]]
name = "ball"
shape = "sphere"
size = [0.2, 0.2, 0.2]
at = [0.0, 0.0, 0.1]
texture = "poster"
[[objects]]
name = "floor"
shape = "quad"
size = [4.0, 4.0, 0.0]
texture = "poster"
)";

}  // namespace lumibox::testing
