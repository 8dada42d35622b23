#include "tracking/frame_search.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace lumibox::tracking {
namespace {

constexpr double kBorder = 8.0;  // pixels: nearer to the edge no patch fits

struct Candidate {
  std::uint32_t point = 0;
  Eigen::Vector2d pixel;  // predicted, level 0
  int cell = 0;
  std::uint32_t sightings = 0;
};

std::vector<Candidate> visible_points(const geometry::Camera& camera, const MapView& map,
                                      const geometry::FramePose& pose, int columns,
                                      double cell_size) {
  std::vector<Candidate> visible;
  visible.reserve(map.points.size());
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const auto pixel = geometry::project(camera, pose, map.points[i].position);
    if (!pixel || !camera.contains(*pixel, kBorder)) continue;
    const int cell = static_cast<int>(pixel->y() / cell_size) * columns +
                     static_cast<int>(pixel->x() / cell_size);
    visible.push_back({i, *pixel, cell, map.points[i].sightings});
  }
  return visible;
}

/// Order that takes one point per cell in turn, the best-established first and the cells in mixed
/// order, so that a cut anywhere leaves points all over the picture.
void spread_over_cells(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.sightings > b.sightings;
  });
  // Multiplying by an odd constant permutes the cells (Knuth, TAOCP 3, section 6.4).
  std::vector<std::pair<std::uint64_t, Candidate>> ranked;
  ranked.reserve(candidates.size());
  std::uint64_t rank = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    rank = i > 0 && candidates[i].cell == candidates[i - 1].cell ? rank + 1 : 0;
    const std::uint32_t mixed = static_cast<std::uint32_t>(candidates[i].cell) * 2654435761U;
    ranked.emplace_back(rank << 32U | mixed, candidates[i]);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < ranked.size(); ++i) candidates[i] = ranked[i].second;
}

std::optional<Measurement> find_point(const geometry::Camera& camera, const MapView& map,
                                      const Pyramid& frame, const Candidate& candidate,
                                      const PatchWarp& warp, const SearchPass& pass) {
  const auto patch = make_template(warp.source->level(warp.source_level), warp.source_pixel,
                                   warp.source_from_target);
  if (!patch) return std::nullopt;
  const hal::Image& image = frame.level(warp.target_level);
  const auto found =
      search_square(image, *patch, to_level(candidate.pixel, warp.target_level), pass.radius);
  if (!found || found->correlation < pass.min_correlation) return std::nullopt;
  const auto aligned = align_patch(image, *patch, found->pixel);
  if (!aligned) return std::nullopt;
  Measurement m;
  m.point = candidate.point;
  m.position = map.points[candidate.point].position;
  m.pixel = from_level(*aligned, warp.target_level);
  m.level = warp.target_level;
  if (!camera.contains(m.pixel, 0.0)) return std::nullopt;
  return m;
}

}  // namespace

SearchResult search_map(const geometry::Camera& camera, const MapView& map, const Pyramid& frame,
                        const geometry::FramePose& pose, const SearchPass& pass) {
  constexpr double kCell = 32.0;
  const int columns = static_cast<int>(camera.width() / kCell) + 1;
  std::vector<Candidate> candidates = visible_points(camera, map, pose, columns, kCell);
  spread_over_cells(candidates);

  SearchResult result;
  for (const Candidate& candidate : candidates) {
    if (result.attempted.size() >= static_cast<std::size_t>(pass.max_points)) break;
    const MapView::Point& point = map.points[candidate.point];
    const std::span<const Sighting> sightings(map.sightings.data() + point.first_sighting,
                                              point.sightings);
    const auto warp =
        plan_warp(camera, map, point.position, sightings, pose.camera_from_world, pass.min_level);
    if (!warp) continue;
    result.attempted.push_back(candidate.point);
    if (auto m = find_point(camera, map, frame, candidate, *warp, pass)) {
      result.measurements.push_back(*m);
    }
  }
  return result;
}

}  // namespace lumibox::tracking
