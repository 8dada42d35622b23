#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "lightfield/perspective.h"

namespace lumibox::render {

enum class Aperture { Small, Wide };

struct DepthMap;
struct Shape;

/// The requested perspective p_req of thesis 3: a pinhole camera. Distortion of `camera` is
/// ignored.
struct View {
  geometry::Camera camera;
  geometry::Pose world_from_camera;
};

/// Most perspectives that one view blends: their data fit the 16 KiB of a uniform block that every
/// OpenGL ES 3 device has.
inline constexpr std::size_t kMaxLayers = 128;

/// How a view is reconstructed (thesis 3).
struct Settings {
  Aperture aperture = Aperture::Small;
  int k = 40;                                       ///< perspectives blended, at most kMaxLayers
  double exponent = 2.0;                            ///< of the weights, wide aperture only
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();  ///< S: every proxy plane passes through it
  double feather_px = 24.0;                         ///< width of the faded border
  double small_aperture_alpha = 0.4;                ///< thesis 3.2
  double small_aperture_stop = 0.004;               ///< transmittance at which a pixel is done
  int aperture_views = 64;                          ///< of a Bokeh, at most LightMean::kMost
  /// The scene's shape in the view: pictures are projected onto that instead of planes, and at each
  /// pixel those count most that see it nearly as the view does; `aperture` means nothing then.
  std::shared_ptr<const Shape> shape;
};

/// Settings from the configuration, focus at S.
Settings settings_from(const config::Render& options, Aperture aperture,
                       const Eigen::Vector3d& focus);

/// Settings of the augmented aperture (thesis 2.2): wide, all weights equal.
Settings augmented_settings_from(const config::Render& options, const Eigen::Vector3d& focus);

/// One of the k perspectives of a view, ready to draw.
struct Layer {
  std::size_t perspective = 0;  ///< index into the vector given to plan_view
  double penalty = 0.0;         ///< angle at S, radians
  double weight = 0.0;          ///< wide: normalised weight; small: alpha
  Eigen::Vector3d normal;       ///< of the proxy plane through S, in world (thesis 3.1)
  /// Undistorted normalised source coordinates of a pixel of the view, up to scale:
  /// source ~ source_from_pixel * (u, v, 1). Where the plane point lies before the view, the third
  /// coordinate is positive exactly where it lies before the source camera too.
  Eigen::Matrix3d source_from_pixel;
  /// before_view . (u, v, 1) is positive exactly where the pixel's ray meets the plane before the
  /// view and not behind it.
  Eigen::Vector3d before_view;
  /// With a shape instead of planes: source ~ source_from_pixel * (u, v, 1) + inverse depth *
  /// shift, where source_from_pixel only turns. Zero with planes.
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  std::shared_ptr<const DepthMap> map;  ///< what hides a shape from it; may be null
};

/// Radians for twice the distance.
inline constexpr double kFartherPenalty = 0.1;
/// Radians; where the view is a recorded one, that counts nearly alone.
inline constexpr double kLeastPenalty = 0.004;
/// Inverse depths, relative to that of a point, between which what is seen comes to hide it.
inline constexpr double kBefore = 1.05;
inline constexpr double kHiding = 1.25;
/// Weight of a perspective from which a point is hidden, for where it is hidden from all.
inline constexpr double kHidden = 0.0005;

/// What a pixel of a shape makes of a perspective that sees it: the view's ray to it and the
/// perspective's, both in its camera, any lengths in the ratio of the distances. Unstructured
/// lumigraph rendering (Buehler et al., SIGGRAPH 2001), with a penalty for the angle between the
/// two and for seeing it from farther away; a weight that grows as the penalty falls.
double closeness(const Eigen::Vector3d& ray_of_view, const Eigen::Vector3d& ray_of_source);

/// Whether a perspective that sees something at inverse depth `seen` sees a point that would be at
/// `inverse_depth` there: from 1 smoothly to kHidden.
double visibility(double seen, double inverse_depth);

/// Penalty at which the weights of a wide aperture reach 0: that of the first perspective left out,
/// or of where it would be. 0 without perspectives.
double aperture_limit(const View& view, const std::vector<lightfield::Perspective>& perspectives,
                      const Settings& settings);

/// Layers of a view in order of increasing penalty: selection, proxy planes and weights of
/// thesis 3. Perspectives without a picture (or whose is lost) and those whose plane cannot be seen
/// from the view (edge-on, or behind view or source at every pixel) do not count as candidates.
/// Pure and deterministic: of equal penalties the smaller id comes first.
std::vector<Layer> plan_view(const View& view,
                             const std::vector<lightfield::Perspective>& perspectives,
                             const Settings& settings);

}  // namespace lumibox::render
