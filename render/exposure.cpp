#include "render/exposure.h"

#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "geometry/robust.h"
#include "render/depth_map.h"
#include "render/light.h"
#include "render/reduced.h"
#include "render/sampling.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr int kMaxPixels = 9000;  // 640x480 becomes 80x60: edges a little beside count less
constexpr std::size_t kMostPoints = 3000;  // of the scene, evenly taken from all
constexpr double kDarkest = 12.0;     // stored; below, a step of the value is a tenth of the light
constexpr double kBrightest = 250.0;  // stored; above, a channel is or soon will be clipped
constexpr std::size_t kNeighbours = 6;
constexpr std::size_t kFewest = 30;    // samples that tell a ratio
constexpr double kIndependent = 25.0;  // neighbouring samples err alike: no more count than so many
constexpr double kLeastDeviation = 0.01;  // of a log ratio: highlights and vignetting are not noise
// Of a log gain. Exposures jump from one picture to the next, shading changes slowly with the
// direction and belongs to the light field: so tight, a walk's slow changes stay as they are.
constexpr double kPriorDeviation = 0.03;
constexpr double kMostGain = 4.0;  // two stops; beyond, there is only noise or white to scale
constexpr double kHuber = 1.345;   // deviations, see huber_weight
constexpr int kReweightings = 5;
constexpr int kSolves = 20;           // a ratio that is far off loses its weight slowly
constexpr double kShareOfTick = 0.1;  // of the way to a new gain: a third of a second at 30 Hz

/// Where most values are, and their spread: a mean with Tukey's weights, from the median on. An
/// occluder pulls a median towards itself; it gets no weight here.
std::pair<double, double> robust_mean(const std::vector<double>& values) {
  double mean = geometry::median(values);
  double sigma = 0.0;
  for (int i = 0; i < kReweightings; ++i) {
    std::vector<double> residuals;
    for (const double value : values) residuals.push_back(value - mean);
    sigma = std::max(geometry::mad_sigma(residuals), 1e-6);
    double sum = 0.0;
    double total = 0.0;
    for (const double residual : residuals) {
      const double weight = geometry::tukey_weight(residual, 4.685 * sigma);
      sum += weight * residual;
      total += weight;
    }
    if (total > 0.0) mean += sum / total;
  }
  return {mean, sigma};
}

/// Pairs of neighbours by angle at S, the smaller index first.
std::set<std::pair<std::size_t, std::size_t>> neighbours(
    const std::vector<Perspective>& perspectives, const Eigen::Vector3d& subject) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    if (!perspectives[i].can_be_shown()) continue;
    std::size_t count = 0;
    for (const auto& [angle, j] :
         nearest_by_angle(perspectives, perspectives[i].center(), subject)) {
      if (j == i) continue;
      if (count++ == kNeighbours) break;
      pairs.insert(std::minmax(i, j));
    }
  }
  return pairs;
}

/// Logarithms of a picture's light at points of the scene; NaN where it does not tell.
std::vector<float> log_lights(const Perspective& perspective, const geometry::Camera& camera,
                              const std::vector<float>& light,
                              const std::vector<Eigen::Vector3d>& points) {
  const geometry::Pose camera_from_world = perspective.world_from_camera.inverse();
  std::vector<float> logs;
  for (const Eigen::Vector3d& point : points) {
    const auto pixel = camera.project(camera_from_world * point);
    const bool seen = pixel && camera.contains(*pixel);
    logs.push_back(seen ? std::log(sample_bilinear(light, camera.width(), camera.height(),
                                                   static_cast<float>(pixel->x()),
                                                   static_cast<float>(pixel->y())))
                        : kNothing);
  }
  return logs;
}

/// Ratio of the light of pictures i and j, of which the logarithms at the same points are given;
/// none if too few tell.
std::optional<LightRatio> compare(std::size_t i, const std::vector<float>& first, std::size_t j,
                                  const std::vector<float>& second) {
  std::vector<double> ratios;
  for (std::size_t p = 0; p < std::min(first.size(), second.size()); ++p) {
    const double ratio = static_cast<double>(second[p]) - static_cast<double>(first[p]);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  if (ratios.size() < kFewest) return std::nullopt;
  const auto [mean, sigma] = robust_mean(ratios);
  return LightRatio{i, j, mean,
                    std::sqrt(sigma * sigma / kIndependent + kLeastDeviation * kLeastDeviation)};
}

/// Logarithms of the gains for fixed weights of the ratios: (sum of squares of ratio and gains,
/// plus the prior) has its minimum where a sparse linear system says.
Eigen::VectorXd solve(std::size_t count, const std::vector<LightRatio>& ratios,
                      const std::vector<double>& weights) {
  using Entry = Eigen::Triplet<double>;
  const auto size = static_cast<Eigen::Index>(count);
  std::vector<Entry> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1.0 / std::pow(kPriorDeviation, 2));
  for (std::size_t r = 0; r < ratios.size(); ++r) {
    const int a = static_cast<int>(ratios[r].first);
    const int b = static_cast<int>(ratios[r].second);
    const double weight = weights[r];
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(a, b, -weight);
    entries.emplace_back(b, a, -weight);
    right[a] += weight * ratios[r].log_ratio;
    right[b] -= weight * ratios[r].log_ratio;
  }
  Eigen::SparseMatrix<double> normal(size, size);
  normal.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(normal).solve(right);
}

}  // namespace

std::vector<double> gains_from(std::size_t count, const std::vector<LightRatio>& ratios) {
  std::vector<double> gains(count, 1.0);
  if (ratios.empty()) return gains;
  Eigen::VectorXd logs = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  std::vector<double> weights;
  for (const LightRatio& ratio : ratios) weights.push_back(1.0 / std::pow(ratio.deviation, 2));
  for (int i = 0; i < kSolves; ++i) {
    logs = solve(count, ratios, weights);
    for (std::size_t r = 0; r < ratios.size(); ++r) {
      const LightRatio& ratio = ratios[r];
      const double residual = ratio.log_ratio + logs[static_cast<Eigen::Index>(ratio.second)] -
                              logs[static_cast<Eigen::Index>(ratio.first)];
      weights[r] =
          geometry::huber_weight(residual / ratio.deviation, kHuber) / std::pow(ratio.deviation, 2);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    gains[i] = std::clamp(std::exp(logs[static_cast<Eigen::Index>(i)]), 1.0 / kMostGain, kMostGain);
  }
  return gains;
}

Exposure::LightPicture Exposure::make_picture(const Perspective& perspective) {
  static const std::array<double, 256> kLight = [] {
    std::array<double, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = light_of(static_cast<double>(i));
    return table;
  }();
  LightPicture picture;
  picture.photo = perspective.photo;
  const auto small = reduced(perspective, kMaxPixels);
  const auto pixels = small ? small->photo->rgb() : nullptr;
  if (!pixels) return picture;  // lost
  picture.camera = small->camera;
  for (int y = 0; y < pixels->height(); ++y) {
    for (int x = 0; x < pixels->width(); ++x) {
      const std::uint8_t* rgb = pixels->at(x, y);
      // Rec. 709, which sRGB's primaries are.
      const double light =
          0.2126 * kLight[rgb[0]] + 0.7152 * kLight[rgb[1]] + 0.0722 * kLight[rgb[2]];
      const bool tells =
          std::max({rgb[0], rgb[1], rgb[2]}) <= kBrightest && light >= light_of(kDarkest);
      picture.light.push_back(tells ? static_cast<float>(light) : kNothing);
    }
  }
  return picture;
}

/// Null if the picture is lost.
const Exposure::LightPicture* Exposure::picture_of(const Perspective& perspective) {
  if (!perspective.can_be_shown()) return nullptr;
  LightPicture& known = pictures_[perspective.photo.get()];
  if (known.photo.lock() != perspective.photo) known = make_picture(perspective);
  return known.camera ? &known : nullptr;
}

std::vector<double> Exposure::gains(const std::vector<Perspective>& perspectives,
                                    const Eigen::Vector3d& focus,
                                    const std::vector<Eigen::Vector3d>& points) {
  std::erase_if(pictures_, [](const auto& entry) { return entry.second.photo.expired(); });
  std::vector<Eigen::Vector3d> compared;
  const std::size_t stride = points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) compared.push_back(points[i]);
  std::vector<std::vector<float>> logs(perspectives.size());
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    if (const LightPicture* picture = picture_of(perspectives[i])) {
      logs[i] = log_lights(perspectives[i], *picture->camera, picture->light, compared);
    }
  }
  std::vector<LightRatio> ratios;
  for (const auto& [i, j] : neighbours(perspectives, focus)) {
    if (const auto ratio = compare(i, logs[i], j, logs[j])) ratios.push_back(*ratio);
  }
  return gains_from(perspectives.size(), ratios);
}

const std::map<int, double>& EasedGains::step(const std::map<int, double>& found) {
  std::map<int, double> gains;
  for (const auto& [id, gain] : found) {
    const auto before = gains_.find(id);
    const double from = before == gains_.end() ? 1.0 : before->second;
    gains[id] = from * std::pow(gain / from, kShareOfTick);
  }
  gains_ = std::move(gains);
  return gains_;
}

}  // namespace lumibox::render
