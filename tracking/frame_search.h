#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/camera.h"
#include "geometry/rolling_shutter.h"
#include "tracking/map_view.h"
#include "tracking/point_matcher.h"
#include "tracking/pose_estimator.h"
#include "tracking/pyramid.h"

namespace lumibox::tracking {

/// How one pass looks for map points.
struct SearchPass {
  int min_level = 0;     ///< search on this level or coarser ones
  double radius = 4.0;   ///< pixels of the level searched
  int max_points = 700;  ///< spread over the picture
  double min_correlation = kMinCorrelation;
};

/// What a pass found; every point of `attempted` should be visible from the predicted pose.
struct SearchResult {
  std::vector<std::uint32_t> attempted;   ///< indices into MapView::points
  std::vector<Measurement> measurements;  ///< those found
};

/// Looks for a map's points in frames; keeps its memory from one to the next.
class FrameSearch {
 public:
  explicit FrameSearch(const geometry::Camera& camera);

  /// Looks for the map's points around where `pose` predicts them, and overwrites `result`.
  void search(const MapView& map, const Pyramid& frame, const geometry::FramePose& pose,
              const SearchPass& pass, SearchResult& result);

 private:
  struct Candidate {
    std::uint32_t point = 0;
    std::uint32_t sightings = 0;
    std::uint32_t cell = 0;
    Eigen::Vector2d pixel;  ///< predicted, level 0
  };

  void set_rows(const geometry::Vector6d& readout_twist);
  std::optional<Eigen::Vector2d> predict(const Eigen::Vector3d& point_in_frame) const;
  void find_visible(const MapView& map, const geometry::FramePose& pose);
  void sort_into_cells();
  std::span<const Candidate> cell(std::uint32_t index) const {
    return std::span(sorted_).subspan(first_[index], first_[index + 1] - first_[index]);
  }
  void attempt(const MapView& map, const Pyramid& frame, const geometry::FramePose& pose,
               const SearchPass& pass, const Candidate& candidate, SearchResult& result) const;

  geometry::Camera camera_;
  int columns_;                                 ///< of cells
  std::vector<geometry::Pose> row_from_frame_;  ///< of every kRows-th row of a rolling shutter
  std::vector<std::uint32_t> mixed_;            ///< all cells, in an order without neighbours
  std::vector<Candidate> visible_;              ///< by index of the point
  std::vector<Candidate> sorted_;               ///< by cell, in each the best-established first
  std::vector<std::uint32_t> first_;            ///< of each cell in sorted_, and the end
  std::vector<std::uint32_t> next_;             ///< the same while sorting
};

/// The same with memory of its own.
SearchResult search_map(const geometry::Camera& camera, const MapView& map, const Pyramid& frame,
                        const geometry::FramePose& pose, const SearchPass& pass);

}  // namespace lumibox::tracking
