#include "render/depth_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "lightfield/light_field.h"
#include "render/cost_volume.h"
#include "render/reduced.h"
#include "render/sampling.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr int kMaxPixels = 36000;  // of a map; 640x480 becomes 160x120
constexpr int kDepths = 48;
constexpr double kNearest = 3.0;  // times as near as the focus
constexpr std::size_t kNeighbours = 4;
constexpr double kMinAngle = 0.03;     // radians at S
constexpr float kCostOfDoubt = 0.04F;  // of colours from 0 to 1
constexpr float kLeastConfidence = 0.02F;

/// The perspective's picture, small and without the lens's distortion; grey where it has no pixel.
/// None if the picture is lost.
std::optional<SmallPicture> small_picture(const Perspective& perspective) {
  const std::optional<Perspective> small_perspective = reduced(perspective, kMaxPixels);
  if (!small_perspective) return std::nullopt;
  const std::shared_ptr<const hal::Image> pixels = small_perspective->photo->rgb();
  if (!pixels) return std::nullopt;
  const hal::Image& image = *pixels;
  const geometry::Camera& lens = *small_perspective->camera;
  SmallPicture small{lens.undistorted(), perspective.world_from_camera, {}};
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      Eigen::Vector3d color = Eigen::Vector3d::Constant(127.5);
      const auto ray = small.camera.unproject(Eigen::Vector2d(x, y));
      const auto pixel = ray ? lens.project(ray->homogeneous()) : std::nullopt;
      if (pixel && lens.contains(*pixel)) color = sample_bilinear(image, *pixel);
      for (int c = 0; c < 3; ++c) small.rgb.push_back(static_cast<float>(color[c] / 255.0));
    }
  }
  return small;
}

/// Index of the least of some costs, to a fraction by the parabola through its neighbours.
double least(const float* costs, int count) {
  const int best = static_cast<int>(std::min_element(costs, costs + count) - costs);
  if (best == 0 || best == count - 1) return best;
  return best + valley_offset(costs[best - 1], costs[best], costs[best + 1]);
}

}  // namespace

DepthMap::DepthMap(const geometry::Camera& map_camera, const std::vector<float>& inverse_depths,
                   const std::vector<float>& confidences)
    : camera(map_camera), largest(std::max(0.0F, *std::ranges::max_element(inverse_depths))) {
  shares.reserve(inverse_depths.size());
  for (const float rho : inverse_depths) {
    const float share = largest > 0.0F ? std::max(rho, 0.0F) / largest : 0.0F;
    shares.push_back(static_cast<std::uint16_t>(std::lround(65535.0F * share)));
  }
  agreement.reserve(confidences.size());
  for (const float confidence : confidences) {
    agreement.push_back(static_cast<std::uint8_t>(std::max(1L, std::lround(255.0F * confidence))));
  }
}

double DepthMap::along(const Eigen::Vector3d& ray) const {
  const config::CameraProfile& c = camera.profile();
  const float share = sample_bilinear(shares, camera.width(), camera.height(),
                                      static_cast<float>(c.fx * ray.x() / ray.z() + c.cx),
                                      static_cast<float>(c.fy * ray.y() / ray.z() + c.cy));
  return static_cast<double>(largest * (share / 65535.0F));
}

std::vector<std::pair<double, std::size_t>> nearest_by_angle(
    const std::vector<Perspective>& perspectives, const Eigen::Vector3d& center,
    const Eigen::Vector3d& focus) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    if (!perspectives[i].can_be_shown()) continue;
    ranked.emplace_back(lightfield::angle_at_subject(center, focus, perspectives[i].center()), i);
  }
  std::sort(ranked.begin(), ranked.end());
  return ranked;
}

std::vector<std::size_t> depth_neighbours(const std::vector<Perspective>& perspectives,
                                          std::size_t index, const Eigen::Vector3d& focus) {
  std::vector<std::size_t> neighbours;
  for (const auto& [angle, i] :
       nearest_by_angle(perspectives, perspectives[index].center(), focus)) {
    if (angle >= kMinAngle && neighbours.size() < kNeighbours) neighbours.push_back(i);
  }
  return neighbours;
}

std::optional<DepthMap> estimate_depth(const Perspective& perspective,
                                       const std::vector<const Perspective*>& others,
                                       const Eigen::Vector3d& focus) {
  const std::optional<SmallPicture> own = small_picture(perspective);
  if (!own) return std::nullopt;
  const SmallPicture& picture = *own;
  std::vector<SmallPicture> pictures;
  for (const Perspective* other : others) {
    if (auto seen = small_picture(*other)) pictures.push_back(std::move(*seen));
  }
  std::vector<const SmallPicture*> compared;
  for (const SmallPicture& other : pictures) compared.push_back(&other);

  // A perspective at S itself has no neighbours, and must only stay finite.
  const double distance = std::max((focus - perspective.center()).norm(), 1e-6);
  const CostVolume costs(picture, compared, kNearest / distance, kDepths);
  const CostVolume aggregated = costs.aggregated(picture);
  std::vector<float> inverse_depths;
  std::vector<float> confidences;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const double index =
          compared.empty() ? (kDepths - 1) / kNearest : least(aggregated.at(x, y), kDepths);
      const float cost = costs.at(x, y)[std::lround(index)];
      inverse_depths.push_back(static_cast<float>(costs.inverse_depth(index)));
      confidences.push_back(std::min(1.0F, std::exp(-cost / kCostOfDoubt) + kLeastConfidence));
    }
  }
  return DepthMap(picture.camera, inverse_depths, confidences);
}

}  // namespace lumibox::render
