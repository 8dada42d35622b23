#include "tracking/corner_tracks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "geometry/robust.h"
#include "tracking/corners.h"
#include "tracking/opencv_view.h"

namespace lumibox::tracking {
namespace {

constexpr int kCorners = 450;  // several times what two views need, in a third of the time
constexpr int kColumns = 8;    // regions of the picture that the corners are taken from in turn
constexpr int kRows = 6;
constexpr int kWindow = 15;          // pixels, of the flow
constexpr int kLevels = 4;           // halvings, of the flow
constexpr int kIterations = 10;      // of the flow, per level
constexpr double kPrecision = 0.05;  // pixels, of the flow; alignment with the reference follows
constexpr double kRoundTrip = 1.0;   // pixels
constexpr double kStill = 0.003;     // of the picture's width: what noise moves a median by at most
constexpr std::size_t kMaxViews = 60;

/// The best corner of every region, then the second best, and so on.
std::vector<Corner> spread(const std::vector<Corner>& corners, const Pyramid& picture) {
  const hal::Image& image = picture.level(0);
  std::vector<std::vector<Corner>> regions(kColumns * kRows);
  for (const Corner& corner : corners) {
    const Eigen::Vector2d pixel = from_level(corner.pixel, corner.level);
    const int column =
        std::clamp(static_cast<int>(pixel.x() * kColumns / image.width()), 0, kColumns - 1);
    const int row = std::clamp(static_cast<int>(pixel.y() * kRows / image.height()), 0, kRows - 1);
    regions[static_cast<std::size_t>(row * kColumns + column)].push_back(corner);
  }
  std::vector<Corner> chosen;
  for (std::size_t rank = 0; chosen.size() < std::min<std::size_t>(corners.size(), kCorners);
       ++rank) {
    for (const auto& region : regions) {
      if (rank < region.size() && chosen.size() < kCorners) chosen.push_back(region[rank]);
    }
  }
  return chosen;
}

/// Sharpens a place found from frame to frame by comparison with the reference: errors do not add
/// up, and an exposure that changes does no harm.
Eigen::Vector2d refined(const Pyramid& picture, const CornerTracks::Track& track,
                        const Eigen::Vector2d& pixel) {
  constexpr double kFarthest = 1.0;  // pixels of the level: beyond, the two disagree
  if (!track.patch) return pixel;
  const Eigen::Vector2d start = to_level(pixel, track.level);
  const auto aligned = align_patch(picture.level(track.level), *track.patch, start);
  if (!aligned || (*aligned - start).norm() >= kFarthest) return pixel;
  return from_level(*aligned, track.level);
}

cv::Point2f to_cv(const Eigen::Vector2d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

}  // namespace

struct FlowPicture::Levels {
  std::vector<cv::Mat> images;
};

FlowPicture::FlowPicture(std::shared_ptr<const Pyramid> pyramid) : pyramid_(std::move(pyramid)) {
  auto levels = std::make_unique<Levels>();
  cv::buildOpticalFlowPyramid(opencv_view(pyramid_->level(0)), levels->images, {kWindow, kWindow},
                              kLevels);
  levels_ = std::move(levels);
}
FlowPicture::~FlowPicture() = default;

std::vector<std::optional<Eigen::Vector2d>> FlowPicture::find(
    const FlowPicture& from, const std::vector<Eigen::Vector2d>& pixels) const {
  std::vector<std::optional<Eigen::Vector2d>> result(pixels.size());
  if (pixels.empty()) return result;
  std::vector<cv::Point2f> before;
  for (const Eigen::Vector2d& pixel : pixels) before.push_back(to_cv(pixel));
  std::vector<cv::Point2f> after;
  std::vector<cv::Point2f> back;
  std::vector<std::uint8_t> found;
  std::vector<std::uint8_t> found_back;
  const cv::Size window(kWindow, kWindow);
  const cv::TermCriteria enough(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kIterations,
                                kPrecision);
  cv::calcOpticalFlowPyrLK(from.levels_->images, levels_->images, before, after, found,
                           cv::noArray(), window, kLevels, enough);
  cv::calcOpticalFlowPyrLK(levels_->images, from.levels_->images, after, back, found_back,
                           cv::noArray(), window, kLevels, enough);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (found[i] == 0 || found_back[i] == 0 || cv::norm(back[i] - before[i]) > kRoundTrip) continue;
    result[i] = Eigen::Vector2d(static_cast<double>(after[i].x), static_cast<double>(after[i].y));
  }
  return result;
}

CornerTracks::CornerTracks(std::shared_ptr<const FlowPicture> reference, std::int64_t timestamp_ns,
                           int fast_threshold)
    : reference_(reference->shared_pyramid()),
      last_(std::move(reference)),
      times_ns_{timestamp_ns},
      still_until_ns_(timestamp_ns) {
  constexpr int kCandidates = 1200;  // as many as cover the picture
  for (const Corner& corner :
       spread(detect_corners(*reference_, fast_threshold, kCandidates), *reference_)) {
    tracks_.push_back({{from_level(corner.pixel, corner.level)},
                       corner.level,
                       make_template(reference_->level(corner.level), corner.pixel,
                                     Eigen::Matrix2d::Identity())});
  }
  count_at_start_ = tracks_.size();
}

void CornerTracks::follow(std::shared_ptr<const FlowPicture> picture, std::int64_t timestamp_ns,
                          const geometry::Camera& camera) {
  std::vector<Eigen::Vector2d> before;
  for (const Track& track : tracks_) before.push_back(track.path.back());
  const auto after = picture->find(*last_, before);
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!after[i]) continue;
    const Eigen::Vector2d pixel = refined(picture->pyramid(), tracks_[i], *after[i]);
    if (!camera.contains(pixel, 4.0) || !camera.unproject(pixel)) continue;
    kept.push_back(std::move(tracks_[i]));
    kept.back().path.push_back(pixel);
  }
  tracks_ = std::move(kept);
  times_ns_.push_back(timestamp_ns);
  last_ = std::move(picture);
  ++frames_;
  forget_views();
}

/// A camera that stays where it is adds no view, and of many views every other one will do. The
/// views beside the ends are kept: they tell how the camera moved there.
void CornerTracks::forget_views() {
  const auto erase = [this](std::size_t view) {
    const auto at = static_cast<std::ptrdiff_t>(view);
    times_ns_.erase(times_ns_.begin() + at);
    for (Track& track : tracks_) track.path.erase(track.path.begin() + at);
  };
  if (median_flow_px() < kStill * last_->pyramid().level(0).width()) {
    still_until_ns_ = times_ns_.back();
    while (times_ns_.size() > 4) erase(times_ns_.size() - 3);
  } else if (times_ns_.size() > kMaxViews) {
    for (std::size_t view = kMaxViews - 3; view > 1 && view < kMaxViews; view -= 2) erase(view);
  }
}

double CornerTracks::share() const {
  return static_cast<double>(tracks_.size()) /
         static_cast<double>(std::max<std::size_t>(count_at_start_, 1));
}

double CornerTracks::median_flow_px() const {
  std::vector<double> flow;
  for (const Track& track : tracks_)
    flow.push_back((track.path.back() - track.path.front()).norm());
  return geometry::median(std::move(flow));
}

}  // namespace lumibox::tracking
