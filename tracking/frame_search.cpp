#include "tracking/frame_search.h"

#include <algorithm>
#include <numeric>

namespace lumibox::tracking {
namespace {

constexpr double kBorder = 8.0;  // pixels: nearer to the edge no patch fits
constexpr int kCell = 32;        // pixels
constexpr int kRows = 8;         // that share a pose: a sixtieth of the motion during the readout

std::optional<Measurement> find_point(const geometry::Camera& camera, const Pyramid& frame,
                                      const Eigen::Vector2d& predicted, const PatchWarp& warp,
                                      const SearchPass& pass) {
  const auto patch = make_template(warp.source->level(warp.source_level), warp.source_pixel,
                                   warp.source_from_target);
  if (!patch) return std::nullopt;
  const hal::Image& image = frame.level(warp.target_level);
  const auto found =
      search_square(image, *patch, to_level(predicted, warp.target_level), pass.radius);
  if (!found || found->correlation < pass.min_correlation) return std::nullopt;
  const auto aligned = align_patch(image, *patch, found->pixel);
  if (!aligned) return std::nullopt;
  Measurement m;
  m.pixel = from_level(*aligned, warp.target_level);
  m.level = warp.target_level;
  if (!camera.contains(m.pixel, 0.0)) return std::nullopt;
  return m;
}

}  // namespace

FrameSearch::FrameSearch(const geometry::Camera& camera)
    : camera_(camera), columns_(camera.width() / kCell + 1) {
  mixed_.resize(static_cast<std::size_t>(columns_ * (camera.height() / kCell + 1)));
  std::iota(mixed_.begin(), mixed_.end(), 0U);
  // Multiplying by an odd constant permutes the cells (Knuth, TAOCP 3, section 6.4).
  std::sort(mixed_.begin(), mixed_.end(),
            [](std::uint32_t a, std::uint32_t b) { return a * 2654435761U < b * 2654435761U; });
  first_.resize(mixed_.size() + 1);
  next_.resize(mixed_.size() + 1);
}

void FrameSearch::set_rows(const geometry::Vector6d& readout_twist) {
  row_from_frame_.clear();
  if (camera_.profile().readout_s == 0.0) return;
  for (int row = kRows / 2; row < camera_.height() + kRows; row += kRows) {
    row_from_frame_.push_back(geometry::row_from_frame(camera_, readout_twist, row));
  }
}

/// As geometry::project, but good to what a search needs only.
std::optional<Eigen::Vector2d> FrameSearch::predict(const Eigen::Vector3d& point_in_frame) const {
  auto pixel = camera_.project(point_in_frame);
  if (row_from_frame_.empty()) return pixel;
  const double last = static_cast<double>(row_from_frame_.size() - 1);
  for (int pass = 0; pass < 2 && pixel; ++pass) {
    const double row = std::clamp(pixel->y() / kRows, 0.0, last);
    pixel = camera_.project(row_from_frame_[static_cast<std::size_t>(row)] * point_in_frame);
  }
  return pixel;
}

void FrameSearch::find_visible(const MapView& map, const geometry::FramePose& pose) {
  visible_.clear();
  set_rows(pose.readout_twist);
  const Eigen::Matrix3d rotation = pose.camera_from_world.matrix3();
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const auto pixel =
        predict(rotation * map.points[i].position + pose.camera_from_world.translation);
    if (!pixel || !camera_.contains(*pixel, kBorder)) continue;
    const int cell =
        static_cast<int>(pixel->y()) / kCell * columns_ + static_cast<int>(pixel->x()) / kCell;
    visible_.push_back({i, map.points[i].sightings, static_cast<std::uint32_t>(cell), *pixel});
  }
}

void FrameSearch::sort_into_cells() {
  std::fill(first_.begin(), first_.end(), 0U);
  for (const Candidate& candidate : visible_) ++first_[candidate.cell + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::copy(first_.begin(), first_.end(), next_.begin());
  sorted_.resize(visible_.size());
  for (const Candidate& candidate : visible_) sorted_[next_[candidate.cell]++] = candidate;
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) {
    std::sort(sorted_.begin() + first_[cell], sorted_.begin() + first_[cell + 1],
              [](const Candidate& a, const Candidate& b) {
                return a.sightings != b.sightings ? a.sightings > b.sightings : a.point < b.point;
              });
  }
}

/// Notes the point as attempted if it can be compared, and as found if it is.
void FrameSearch::attempt(const MapView& map, const Pyramid& frame, const geometry::FramePose& pose,
                          const SearchPass& pass, const Candidate& candidate,
                          SearchResult& result) const {
  const MapView::Point& point = map.points[candidate.point];
  const std::span<const Sighting> sightings(map.sightings.data() + point.first_sighting,
                                            point.sightings);
  const auto warp =
      plan_warp(camera_, map, point.position, sightings, pose.camera_from_world, pass.min_level);
  if (!warp) return;
  result.attempted.push_back(candidate.point);
  if (auto m = find_point(camera_, frame, candidate.pixel, *warp, pass)) {
    m->point = candidate.point;
    m->position = point.position;
    result.measurements.push_back(*m);
  }
}

// One point per cell in turn, the best-established first and the cells in mixed order: a cut
// anywhere leaves points all over the picture.
void FrameSearch::search(const MapView& map, const Pyramid& frame, const geometry::FramePose& pose,
                         const SearchPass& pass, SearchResult& result) {
  result.attempted.clear();
  result.measurements.clear();
  find_visible(map, pose);
  sort_into_cells();
  bool more = true;
  for (std::size_t rank = 0; more; ++rank) {
    more = false;
    for (const std::uint32_t index : mixed_) {
      const std::span<const Candidate> candidates = cell(index);
      if (rank >= candidates.size()) continue;
      if (result.attempted.size() >= static_cast<std::size_t>(pass.max_points)) return;
      attempt(map, frame, pose, pass, candidates[rank], result);
      more = true;
    }
  }
}

SearchResult search_map(const geometry::Camera& camera, const MapView& map, const Pyramid& frame,
                        const geometry::FramePose& pose, const SearchPass& pass) {
  SearchResult result;
  FrameSearch(camera).search(map, frame, pose, pass, result);
  return result;
}

}  // namespace lumibox::tracking
