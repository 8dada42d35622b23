#pragma once

#include "hal/sim/color.h"

namespace lumibox::hal::sim {

/// Red, green, blue and one value that nobody looks at: a colour that fills a vector register.
/// GCC's and Clang's own type, with the operators of a float.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 to_float4(const Color& c) {
  return Float4{c[0], c[1], c[2], 0.0f};
}
inline Color to_color(const Float4& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace lumibox::hal::sim
