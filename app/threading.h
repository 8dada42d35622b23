#pragma once

#include "lightfield/store.h"
#include "render/depth_maps.h"
#include "tracking/tracker.h"

namespace lumibox::app {

/// How the work beside the loop is done.
struct Threading {
  tracking::Mapping mapping = tracking::Mapping::Threaded;
  lightfield::Writing writing = lightfield::Writing::Threaded;
  render::Estimating estimating = render::Estimating::Meanwhile;
};
inline constexpr Threading kThreaded{tracking::Mapping::Threaded, lightfield::Writing::Threaded,
                                     render::Estimating::Meanwhile};
inline constexpr Threading kLockstep{tracking::Mapping::Lockstep, lightfield::Writing::Inline,
                                     render::Estimating::AtOnce};

}  // namespace lumibox::app
