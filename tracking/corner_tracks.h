#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "tracking/patch.h"
#include "tracking/pyramid.h"

namespace lumibox::tracking {

/// A picture prepared for following corners into it; made once per frame.
class FlowPicture {
 public:
  explicit FlowPicture(std::shared_ptr<const Pyramid> pyramid);
  ~FlowPicture();
  const Pyramid& pyramid() const { return *pyramid_; }
  const std::shared_ptr<const Pyramid>& shared_pyramid() const { return pyramid_; }

  /// Where the pixels of `from` (level 0) are in this picture; none where there and back do not
  /// meet (pyramidal Lucas-Kanade, Bouguet, 2000).
  std::vector<std::optional<Eigen::Vector2d>> find(
      const FlowPicture& from, const std::vector<Eigen::Vector2d>& pixels) const;

 private:
  struct Levels;
  std::shared_ptr<const Pyramid> pyramid_;
  std::unique_ptr<const Levels> levels_;
};

/// Corners of a reference picture, followed through the pictures after it.
class CornerTracks {
 public:
  struct Track {
    std::vector<Eigen::Vector2d> path;   ///< pixel of level 0 in each kept view, the first included
    int level = 0;                       ///< its corner was found on
    std::optional<PatchTemplate> patch;  ///< of the reference, on that level
  };

  CornerTracks(std::shared_ptr<const FlowPicture> reference, std::int64_t timestamp_ns,
               int fast_threshold);

  void follow(std::shared_ptr<const FlowPicture> picture, std::int64_t timestamp_ns,
              const geometry::Camera& camera);

  const std::shared_ptr<const Pyramid>& reference() const { return reference_; }
  const std::vector<Track>& tracks() const { return tracks_; }
  /// Of the views that the paths tell of.
  const std::vector<std::int64_t>& times_ns() const { return times_ns_; }
  int frames() const { return frames_; }  ///< followed into, whether kept or not
  std::int64_t still_until_ns() const { return still_until_ns_; }  ///< at the reference's place
  double share() const;           ///< of the corners at the start that are still followed
  double median_flow_px() const;  ///< since the reference

 private:
  void forget_views();

  std::shared_ptr<const Pyramid> reference_;
  std::shared_ptr<const FlowPicture> last_;
  std::vector<Track> tracks_;
  std::vector<std::int64_t> times_ns_;
  std::int64_t still_until_ns_ = 0;
  std::size_t count_at_start_ = 0;
  int frames_ = 0;
};

}  // namespace lumibox::tracking
