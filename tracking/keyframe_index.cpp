#include "tracking/keyframe_index.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <opencv2/features2d.hpp>

#include "geometry/absolute_pose.h"
#include "hal/newer_processors.h"
#include "tracking/opencv_view.h"

namespace lumibox::tracking {
namespace {

constexpr double kRatio = 0.8;  // of the best to the second-best descriptor (Lowe, 2004)

int distance(const Descriptor& a, const Descriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

}  // namespace

DescribedCorners describe(const Pyramid& pyramid, const std::vector<Corner>& corners) {
  const auto orb =
      cv::ORB::create(static_cast<int>(corners.size()) + 1, 2.0F, pyramid.levels(), 20);
  std::vector<cv::KeyPoint> keypoints;
  for (const Corner& c : corners) {
    const Eigen::Vector2d pixel = from_level(c.pixel, c.level);
    cv::KeyPoint k(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                   31.0F * static_cast<float>(1 << c.level), 0.0F, c.score, c.level);
    keypoints.push_back(k);
  }
  cv::Mat rows;
  orb->compute(opencv_view(pyramid.level(0)), keypoints, rows);
  DescribedCorners result;
  result.descriptors.resize(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    result.pixels.emplace_back(static_cast<double>(keypoints[i].pt.x),
                               static_cast<double>(keypoints[i].pt.y));
    std::memcpy(result.descriptors[i].data(), rows.ptr(static_cast<int>(i)), sizeof(Descriptor));
  }
  return result;
}

void KeyframeIndex::update(const MapView& map) {
  for (std::size_t i = entries_.size(); i < map.keyframes.size(); ++i) {
    entries_.emplace_back();
    if (!map.keyframes[i].culled()) entries_.back().small = SmallImage(*map.keyframes[i].pyramid);
  }
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (map.keyframes[i].culled() && !entries_[i].small.empty()) entries_[i] = {};
  }
}

double KeyframeIndex::difference(const SmallImage& picture, KeyframeId keyframe) const {
  const SmallImage& known = entry(keyframe).small;
  double sum = 0.0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const double d = static_cast<double>(picture.at(x, y) - known.at(x, y));
      sum += d * d;
    }
  }
  return sum / (picture.width() * picture.height());
}

const SmallImage& KeyframeIndex::small_image(KeyframeId keyframe) const {
  return entry(keyframe).small;
}

std::vector<KeyframeId> KeyframeIndex::most_alike(
    const SmallImage& picture, std::size_t count,
    const std::function<bool(KeyframeId)>& eligible) const {
  std::vector<std::pair<double, KeyframeId>> ranked;
  for (KeyframeId id = 0; id < static_cast<KeyframeId>(entries_.size()); ++id) {
    if (entry(id).small.empty() || !eligible(id)) continue;
    ranked.emplace_back(difference(picture, id), id);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<KeyframeId> ids;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) ids.push_back(ranked[i].second);
  return ids;
}

KeyframeIndex::Entry& KeyframeIndex::described_entry(const MapView& map, KeyframeId keyframe) {
  Entry& known = entries_[static_cast<std::size_t>(keyframe)];
  if (known.corners) return known;
  std::vector<std::pair<PointId, const Sighting*>> seen;
  std::vector<Corner> corners;
  for (const MapView::Point& p : map.points) {
    for (std::uint32_t i = p.first_sighting; i < p.first_sighting + p.sightings; ++i) {
      const Sighting& s = map.sightings[i];
      if (s.keyframe != keyframe) continue;
      seen.emplace_back(p.id, &s);
      corners.push_back({to_level(s.pixel, s.level), s.level, 1.0F});
    }
  }
  known.corners = describe(*map.keyframes[static_cast<std::size_t>(keyframe)].pyramid, corners);
  // The describer drops corners near the border and may reorder; find each one's point again.
  for (const Eigen::Vector2d& pixel : known.corners->pixels) {
    const auto nearest =
        std::min_element(seen.begin(), seen.end(), [&](const auto& a, const auto& b) {
          return (a.second->pixel - pixel).squaredNorm() < (b.second->pixel - pixel).squaredNorm();
        });
    known.points.push_back(nearest->first);
  }
  return known;
}

const DescribedCorners& KeyframeIndex::corners(const MapView& map, KeyframeId keyframe) {
  return *described_entry(map, keyframe).corners;
}

const std::vector<PointId>& KeyframeIndex::points(const MapView& map, KeyframeId keyframe) {
  return described_entry(map, keyframe).points;
}

LUMIBOX_FOR_NEWER_PROCESSORS  // which count bits in one instruction
    std::vector<PointMatch>
    KeyframeIndex::match(const MapView& map, KeyframeId keyframe, const DescribedCorners& here) {
  const Entry& known = described_entry(map, keyframe);
  std::vector<PointMatch> matches;
  for (std::size_t i = 0; i < here.descriptors.size(); ++i) {
    int best = 257;
    int second = 257;
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < known.points.size(); ++j) {
      const int bits = distance(here.descriptors[i], known.corners->descriptors[j]);
      if (bits < best) {
        second = best;
        best = bits;
        nearest = j;
      } else {
        second = std::min(second, bits);
      }
    }
    if (second > 256 || best > kRatio * second) continue;
    if (find_point(map, known.points[nearest])) matches.push_back({i, known.points[nearest]});
  }
  return matches;
}

int KeyframeIndex::described() const {
  return static_cast<int>(std::count_if(entries_.begin(), entries_.end(),
                                        [](const Entry& e) { return e.corners.has_value(); }));
}

std::optional<geometry::Pose> pose_from_matches(const geometry::Camera& camera, const MapView& map,
                                                const DescribedCorners& corners,
                                                const std::vector<PointMatch>& matches,
                                                std::uint32_t seed) {
  constexpr int kMinInliers = 15;  // matches that must agree on a pose
  constexpr double kMaxErrorPx = 4.0;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> bearings;
  for (const PointMatch& m : matches) {
    const auto ray = camera.unproject(corners.pixels[m.corner]);
    if (!ray) continue;
    points.push_back(find_point(map, m.point)->position);
    bearings.push_back(ray->homogeneous().normalized());
  }
  if (points.size() < kMinInliers) return std::nullopt;
  const auto pose =
      geometry::solve_absolute_pose(points, bearings, kMaxErrorPx / camera.profile().fx, seed);
  if (!pose || pose->inlier_count < kMinInliers) return std::nullopt;
  return pose->camera_from_world;
}

}  // namespace lumibox::tracking
