#pragma once

#include <embree3/rtcore.h>

namespace lumibox::hal::sim {

struct Body;

/// Makes `geometry` (of type USER) the sphere of `body`, which must outlive it.
void set_exact_sphere(RTCGeometry geometry, Body* body);

}  // namespace lumibox::hal::sim
