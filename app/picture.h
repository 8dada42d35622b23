#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/pose.h"
#include "lightfield/perspective.h"
#include "render/overlay.h"
#include "render/proxy_geometry.h"

namespace lumibox::app {

/// A light field as it should appear.
struct LightFieldPicture {
  std::vector<lightfield::Perspective> perspectives;
  render::Settings settings;
  /// Mesh with a wide aperture: on planes as long as the view moves, at rest a render::Bokeh.
  render::Geometry geometry = render::Geometry::Plane;
};

/// What a mode wants on the screen, as plain data: modes know nothing of GL, and what they show can
/// be tested without it.
struct Picture {
  /// From where the light field and the coverage map are seen; without it neither is drawn.
  std::optional<geometry::Pose> world_from_view;
  std::optional<LightFieldPicture> light_field;  ///< in place of the camera's own picture
  std::optional<render::Coverage> coverage;
  /// Where on the screen the box should be moved to, right and down; not zero.
  std::optional<Eigen::Vector2d> way;
  bool reticle = false;
  std::string title;                ///< where one is: mode and numbers
  std::string details;              ///< more numbers, below the title
  std::string advice;               ///< what the person should do now
  std::vector<std::string> alerts;  ///< what is wrong
  /// How the box is doing, for those who asked to see it.
  std::vector<std::string> figures;
};

}  // namespace lumibox::app
