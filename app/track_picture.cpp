#include "app/track_picture.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace lumibox::app {
namespace {

std::string counts(const nlohmann::json& s) {
  const auto number = [&](const char* name) { return s[name].get<long long>(); };
  std::string text = fmt::format("{} frames, {} tracked", number("frames"), number("tracked"));
  if (!s["initialised_at_frame"].is_null()) {
    text += fmt::format(" from frame {} on, {} lost after it", number("initialised_at_frame"),
                        number("lost"));
  }
  return text + fmt::format("; {} keyframes, {} points, {} relocalisations, {} loops closed",
                            number("keyframes"), number("points"), number("relocalisations"),
                            number("loops_closed"));
}

std::string times(const nlohmann::json& ms) {
  return fmt::format("Tracker: {:.1f} ms median, {:.1f} ms p95, {:.1f} ms at most",
                     ms["median"].get<double>(), ms["p95"].get<double>(), ms["max"].get<double>());
}

/// RMSE after alignment; empty without a truth.
std::string errors(const nlohmann::json& s) {
  std::string text;
  for (const std::string which : {"live", "final"}) {
    if (!s.contains("ate_" + which)) return {};
    const std::string percent = "ate_" + which + "_percent";
    const std::string share =
        s.contains(percent) ? fmt::format(" ({:.3g} % of the extent)", s[percent].get<double>())
                            : " (the extent is zero)";
    text += fmt::format("{}{} {:.4g}{}, rotation {:.3g}°", text.empty() ? "Error (RMSE): " : "; ",
                        which, s["ate_" + which].get<double>(), share,
                        s["rotation_rmse_deg_" + which].get<double>());
  }
  return text;
}

std::string losses(const nlohmann::json& s) {
  constexpr std::size_t kNamed = 4;  // as many as fit a line
  const nlohmann::json& all = s["losses"];
  std::string text;
  for (std::size_t i = 0; i < std::min(all.size(), kNamed); ++i) {
    text += fmt::format("{}{} to {}, {}", i == 0 ? "Lost in frames " : "; ",
                        all[i]["first_frame"].get<long long>(),
                        all[i]["last_frame"].get<long long>(), all[i]["reason"].get<std::string>());
  }
  return all.size() > kNamed ? text + fmt::format("; and {} times more", all.size() - kNamed)
                             : text;
}

}  // namespace

bench::TrackPlot begin_plot(const tracking::Tracker& tracker, const hal::Sequence& sequence,
                            const nlohmann::json& statistics) {
  bench::TrackPlot plot;
  plot.title = "Tracking of " + sequence.path.string();
  plot.figures = {counts(statistics), times(statistics["ms"])};
  for (const std::string& line : {errors(statistics), losses(statistics)}) {
    if (!line.empty()) plot.figures.push_back(line);
  }
  plot.truth = sequence.ground_truth;
  for (const tracking::MapPoint& point : tracker.points()) {
    plot.points.push_back(point.position);
  }
  for (tracking::KeyframeId id = 0;; ++id) {
    const auto keyframe = tracker.world_from_keyframe(id);
    if (!keyframe) break;
    plot.keyframes.push_back(keyframe->rigid);
  }
  return plot;
}

}  // namespace lumibox::app
