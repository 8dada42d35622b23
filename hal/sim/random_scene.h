#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

#include "hal/sim/scene_spec.h"

/// Scenes that nobody has tuned to: everything that a scene file states is drawn at random.
namespace lumibox::hal::sim {

enum class Place {
  Desk,    ///< things on a desk, in a room or not
  Can,     ///< a can, carton or bottle on a plain floor
  Glass,   ///< a ball of glass on a desk in a room; names the effect refraction
  Mirror,  ///< a ball that mirrors, likewise; names the effect reflection
  Facade,  ///< a house front across the street
};
inline constexpr std::array<std::string_view, 5> kPlaceNames{"desk", "can", "glass", "mirror",
                                                             "facade"};

enum class Walk {
  Arc,    ///< to and fro over part of a sphere
  Orbit,  ///< once around and a little more; heights and distances at both ends are the same
  Turn,   ///< an arc, in whose middle the hand stops, turns away by about 40 degrees and back
  Shake,  ///< an arc, in whose middle the hand is shaken violently for half a second
};
inline constexpr std::array<std::string_view, 4> kWalkNames{"arc", "orbit", "turn", "shake"};

struct RandomSceneOptions {
  std::uint64_t seed = 0;
  std::optional<Place> place;  ///< drawn if not given
  std::optional<Walk> walk;    ///< drawn if not given; a facade cannot be orbited
  std::set<Effect> effects;    ///< besides the one that the place names
};

/// The scene that belongs to the options, the same on every call. 640x480 pixels, 30 Hz, 10 to 21
/// seconds. Throws config::InputError for a facade with an orbit.
SceneSpec random_scene(const RandomSceneOptions& options);

}  // namespace lumibox::hal::sim
