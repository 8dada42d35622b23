#include "tracking/relocaliser.h"

#include <vector>

#include "tracking/corners.h"
#include "tracking/keyframe_index.h"

namespace lumibox::tracking {
namespace {

constexpr std::size_t kShortlist = 6;  // keyframes matched in full

}  // namespace

class Relocaliser::Impl {
 public:
  Impl(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed)
      : camera_(camera), options_(options), seed_(seed) {}

  std::vector<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                   const SmallImage& small) {
    const DescribedCorners here = describe(
        frame, detect_corners(frame, options_.fast_threshold, options_.max_features_per_keyframe));
    if (here.pixels.empty()) return {};
    index_.update(map);
    std::vector<geometry::Pose> poses;
    const auto any = [](KeyframeId) { return true; };
    for (const KeyframeId id : index_.most_alike(small, kShortlist, any)) {
      const auto pose = pose_from_matches(camera_, map, here, index_.match(map, id, here), seed_);
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

std::vector<geometry::Pose> Relocaliser::find(const MapView& map, const Pyramid& frame,
                                              const SmallImage& small) {
  return impl_->find(map, frame, small);
}

}  // namespace lumibox::tracking
