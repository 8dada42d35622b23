#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/image.h"
#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

struct Color {
  float r = 1.0F, g = 1.0F, b = 1.0F, a = 1.0F;
};

/// One line of text: FreeType, sans serif.
struct Text {
  std::string utf8;
  float x = 0.0F;      ///< pixels from the left edge
  float y = 0.0F;      ///< baseline, pixels from the top edge
  float size = 18.0F;  ///< pixels
  Color color;
};

/// What the coverage map shows (thesis 2.3).
struct Coverage {
  /// A recorded perspective.
  struct Dot {
    Eigen::Vector3d center;      ///< in world
    std::optional<double> psnr;  ///< dB, see color_of_quality
    bool disagrees = false;      ///< with those around it
  };

  lightfield::Sphere sphere;
  std::vector<Dot> recorded;
  std::optional<Eigen::Vector3d> current;  ///< the camera's centre in world
  std::optional<Eigen::Vector3d> hole;     ///< direction from S in which to go next, unit, in world
};

/// Draws what lies over a picture: the camera's own image, the coverage map (thesis 2.3: wireframe
/// sphere, a dot per recorded perspective, a red dot for the camera), text, reticle, arrow. All
/// calls need the same current context, the destructor included.
class Overlay {
 public:
  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// The live picture over the whole framebuffer, undistorted by `camera` so that it matches
  /// `view`, with the given opacity.
  void draw_image(const hal::Image& color, const geometry::Camera& camera, const View& view,
                  float opacity, unsigned framebuffer);

  /// Sphere and dots as seen from `view`. The dots lie where the line from each centre to S meets
  /// the sphere; those on the far side are drawn dimmer.
  void draw_coverage(const Coverage& coverage, const View& view, unsigned framebuffer);

  /// A cross hair in the middle of a picture of this size.
  void draw_reticle(int width, int height, unsigned framebuffer);

  /// An arrow near the edge of a picture of this size that points outwards in the direction `way`
  /// (right and down, any length but zero).
  void draw_arrow(const Eigen::Vector2d& way, int width, int height, unsigned framebuffer);

  void draw_text(const std::vector<Text>& lines, int width, int height, unsigned framebuffer);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::render
