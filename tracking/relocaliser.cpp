#include "tracking/relocaliser.h"

#include <algorithm>
#include <vector>

#include "tracking/corners.h"
#include "tracking/keyframe_index.h"

namespace lumibox::tracking {
namespace {

constexpr std::size_t kShortlist = 6;  // keyframes matched in full
constexpr std::size_t kTried = 3;      // of those, that a pose is sought from: the best matches
constexpr int kDescribedPerFrame = 2;  // keyframes: each takes as long as tracking a frame or two
constexpr int kCornersOfFrame = 600;   // matched: half of a keyframe's, the strongest

}  // namespace

class Relocaliser::Impl {
 public:
  Impl(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed)
      : camera_(camera), options_(options), seed_(seed) {}

  std::vector<KeyframeId> prepare(const MapView& map, const SmallImage& small) {
    index_.update(map);
    const auto any = [](KeyframeId) { return true; };
    std::vector<KeyframeId> shortlist = index_.most_alike(small, kShortlist, any);
    int left = kDescribedPerFrame;
    for (const KeyframeId id : shortlist) {
      if (index_.is_described(id)) continue;
      if (left-- == 0) return {};
      index_.corners(map, id);
    }
    return shortlist;
  }

  std::vector<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                   const SmallImage& small) {
    const std::vector<KeyframeId> shortlist = prepare(map, small);
    if (shortlist.empty()) return {};
    const DescribedCorners here = describe(
        frame, detect_corners(frame, options_.fast_threshold,
                              std::min(kCornersOfFrame, options_.max_features_per_keyframe)));
    std::vector<std::vector<PointMatch>> matched;
    for (const KeyframeId id : shortlist) matched.push_back(index_.match(map, id, here));
    std::stable_sort(matched.begin(), matched.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    std::vector<geometry::Pose> poses;
    for (std::size_t i = 0; i < std::min(kTried, matched.size()); ++i) {
      const auto pose = pose_from_matches(camera_, map, here, matched[i], seed_);
      if (pose) poses.push_back(*pose);
    }
    return poses;
  }

  int described() const { return index_.described(); }

 private:
  geometry::Camera camera_;
  config::Tracking options_;
  std::uint32_t seed_;
  KeyframeIndex index_;
};

Relocaliser::Relocaliser(const geometry::Camera& camera, const config::Tracking& options,
                         std::uint32_t seed)
    : impl_(std::make_unique<Impl>(camera, options, seed)) {}
Relocaliser::~Relocaliser() = default;

int Relocaliser::described() const {
  return impl_->described();
}

void Relocaliser::prepare(const MapView& map, const SmallImage& small) {
  impl_->prepare(map, small);
}

std::vector<geometry::Pose> Relocaliser::find(const MapView& map, const Pyramid& frame,
                                              const SmallImage& small) {
  return impl_->find(map, frame, small);
}

}  // namespace lumibox::tracking
