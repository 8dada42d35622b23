#pragma once

#include "app/loop.h"
#include "hal/sim/scene.h"

namespace lumibox::app {

/// Compares a finished run with what only the simulator knows, and says the result on stdout: where
/// the recorded perspectives really were, and what the views between them really look like.
void say_quality(const hal::Scene& scene, const Loop& loop);

}  // namespace lumibox::app
