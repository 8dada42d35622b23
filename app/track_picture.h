#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bench/track_plot.h"
#include "hal/replay/sequence.h"
#include "tracking/tracker.h"

namespace lumibox::app {

/// The picture of `track --plot` as far as the tracker, the recording and the statistics of
/// `track --json` make it up; frames, trajectories and perspectives are added by the command.
bench::TrackPlot begin_plot(const tracking::Tracker& tracker, const hal::Sequence& sequence,
                            const nlohmann::json& statistics);

}  // namespace lumibox::app
