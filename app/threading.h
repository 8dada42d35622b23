#pragma once

#include "lightfield/store.h"
#include "tracking/tracker.h"

namespace lumibox::app {

/// How the work beside the loop is done.
struct Threading {
  tracking::Mapping mapping = tracking::Mapping::Threaded;
  lightfield::Writing writing = lightfield::Writing::Threaded;
};
inline constexpr Threading kThreaded{tracking::Mapping::Threaded, lightfield::Writing::Threaded};
inline constexpr Threading kLockstep{tracking::Mapping::Lockstep, lightfield::Writing::Inline};

}  // namespace lumibox::app
