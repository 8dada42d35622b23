#include "tracking/relocaliser.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <vector>

#include "geometry/absolute_pose.h"
#include "tracking/corners.h"
#include "tracking/opencv_view.h"

namespace lumibox::tracking {
namespace {

constexpr std::size_t kShortlist = 6;  // keyframes matched in full
constexpr float kRatio = 0.8F;         // of the best to the second-best descriptor (Lowe, 2004)
constexpr int kMinInliers = 15;        // matches that must agree on a pose
constexpr double kMaxErrorPx = 4.0;

/// Upright binary descriptors (Rublee et al., "ORB", ICCV 2011): the box is held upright, and
/// without its orientation a descriptor tells more apart.
struct Described {
  std::vector<Eigen::Vector2d> pixels;  // level 0
  cv::Mat descriptors;
};

Described describe(const Pyramid& pyramid, const std::vector<Corner>& corners) {
  const auto orb =
      cv::ORB::create(static_cast<int>(corners.size()) + 1, 2.0F, pyramid.levels(), 20);
  std::vector<cv::KeyPoint> keypoints;
  for (const Corner& c : corners) {
    const Eigen::Vector2d pixel = from_level(c.pixel, c.level);
    cv::KeyPoint k(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                   31.0F * static_cast<float>(1 << c.level), 0.0F, c.score, c.level);
    keypoints.push_back(k);
  }
  const cv::Mat view = opencv_view(pyramid.level(0));
  Described result;
  orb->compute(view, keypoints, result.descriptors);
  for (const cv::KeyPoint& k : keypoints) {
    result.pixels.emplace_back(static_cast<double>(k.pt.x), static_cast<double>(k.pt.y));
  }
  return result;
}

/// Sum of the squared differences of two small images, which have the same size and their means
/// removed.
double difference(const SmallImage& a, const SmallImage& b) {
  double sum = 0.0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const double d = static_cast<double>(a.at(x, y) - b.at(x, y));
      sum += d * d;
    }
  }
  return sum;
}

}  // namespace

class Relocaliser::Impl {
 public:
  Impl(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed)
      : camera_(camera), options_(options), seed_(seed) {}

  std::vector<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                   const SmallImage& small) {
    const Described here = describe(
        frame, detect_corners(frame, options_.fast_threshold, options_.max_features_per_keyframe));
    if (here.pixels.empty()) return {};
    std::vector<geometry::Pose> poses;
    for (const std::size_t id : shortlist(map, small)) {
      if (!known_[id].described) describe_keyframe(map, id);
      const auto pose = match(map, id, here);
      if (pose && pose->inlier_count >= kMinInliers) poses.push_back(pose->camera_from_world);
    }
    return poses;
  }

  int described() const {
    return static_cast<int>(std::count_if(known_.begin(), known_.end(), [](const auto& keyframe) {
      return keyframe.described.has_value();
    }));
  }

 private:
  struct KnownKeyframe {
    SmallImage small;
    std::optional<Described> described;  // at the sightings of map points
    std::vector<PointId> points;         // one per descriptor
  };

  void describe_keyframe(const MapView& map, std::size_t id) {
    KnownKeyframe& known = known_[id];
    std::vector<std::pair<PointId, const Sighting*>> seen;
    for (const MapView::Point& p : map.points) {
      for (std::uint32_t s = p.first_sighting; s < p.first_sighting + p.sightings; ++s) {
        const Sighting& sighting = map.sightings[s];
        if (static_cast<std::size_t>(sighting.keyframe) == id) seen.emplace_back(p.id, &sighting);
      }
    }
    std::vector<Corner> corners;
    for (const auto& [point, s] : seen)
      corners.push_back({to_level(s->pixel, s->level), s->level, 1.0F});
    known.described = describe(*map.keyframes[id].pyramid, corners);
    // The describer drops corners near the border and may reorder; find each one's point again.
    for (const Eigen::Vector2d& pixel : known.described->pixels) {
      const auto nearest =
          std::min_element(seen.begin(), seen.end(), [&](const auto& a, const auto& b) {
            return (a.second->pixel - pixel).squaredNorm() <
                   (b.second->pixel - pixel).squaredNorm();
          });
      known.points.push_back(nearest->first);
    }
  }

  std::vector<std::size_t> shortlist(const MapView& map, const SmallImage& small) {
    for (std::size_t i = known_.size(); i < map.keyframes.size(); ++i) {
      known_.push_back({SmallImage(*map.keyframes[i].pyramid), std::nullopt, {}});
    }
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      ranked.emplace_back(difference(small, known_[i].small), i);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::size_t> ids;
    for (std::size_t i = 0; i < std::min(kShortlist, ranked.size()); ++i)
      ids.push_back(ranked[i].second);
    return ids;
  }

  std::optional<geometry::AbsolutePose> match(const MapView& map, std::size_t id,
                                              const Described& here) const {
    const KnownKeyframe& known = known_[id];
    if (known.points.empty()) return std::nullopt;
    std::vector<std::vector<cv::DMatch>> matches;
    cv::BFMatcher(cv::NORM_HAMMING)
        .knnMatch(here.descriptors, known.described->descriptors, matches, 2);
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector3d> bearings;
    for (const auto& m : matches) {
      if (m.size() < 2 || m[0].distance > kRatio * m[1].distance) continue;
      const auto point =
          std::lower_bound(map.points.begin(), map.points.end(),
                           known.points[static_cast<std::size_t>(m[0].trainIdx)],
                           [](const MapView::Point& p, PointId wanted) { return p.id < wanted; });
      const bool exists = point != map.points.end() &&
                          point->id == known.points[static_cast<std::size_t>(m[0].trainIdx)];
      const auto ray = camera_.unproject(here.pixels[static_cast<std::size_t>(m[0].queryIdx)]);
      if (!exists || !ray) continue;
      points.push_back(point->position);
      bearings.push_back(ray->homogeneous().normalized());
    }
    if (points.size() < kMinInliers) return std::nullopt;
    return geometry::solve_absolute_pose(points, bearings, kMaxErrorPx / camera_.profile().fx,
                                         seed_);
  }

  geometry::Camera camera_;
  config::Tracking options_;
  std::uint32_t seed_;
  std::vector<KnownKeyframe> known_;  // by KeyframeId
};

Relocaliser::Relocaliser(const geometry::Camera& camera, const config::Tracking& options,
                         std::uint32_t seed)
    : impl_(std::make_unique<Impl>(camera, options, seed)) {}
Relocaliser::~Relocaliser() = default;

int Relocaliser::described() const {
  return impl_->described();
}

std::vector<geometry::Pose> Relocaliser::find(const MapView& map, const Pyramid& frame,
                                              const SmallImage& small) {
  return impl_->find(map, frame, small);
}

}  // namespace lumibox::tracking
