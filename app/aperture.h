#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/moment.h"
#include "app/picture.h"
#include "config/config.h"
#include "geometry/camera.h"

namespace lumibox::app {

/// The augmented aperture of thesis 2.2: the live picture fused with a few frames recorded while
/// the person waves the camera, all with the same weight, in focus on one plane.
class Aperture {
 public:
  Aperture(const geometry::Camera& camera, const config::Aperture& options);

  /// Once per tick. Keeps the moment's frame if it was taken far enough from those kept, as seen
  /// from `focus`; the oldest makes room.
  void update(const Moment& moment, const Eigen::Vector3d& focus);

  int frames() const { return static_cast<int>(kept_.size()); }

  /// Kept frames and the live one, focused on `focus`; after update(). The moment must have a pose.
  LightFieldPicture draw(const Moment& moment, const Eigen::Vector3d& focus,
                         const config::Render& options) const;

 private:
  lightfield::Perspective with_id(const Moment& moment, int id) const;

  std::shared_ptr<const geometry::Camera> camera_;
  config::Aperture options_;
  std::vector<lightfield::Perspective> kept_;  ///< oldest first
  std::shared_ptr<const hal::Image> live_;     ///< picture of the newest frame
  std::shared_ptr<lightfield::Photo>
      live_photo_;    ///< as long as the frame is the newest: one upload
  int next_id_ = -1;  ///< counts down: never the id of a perspective of the light field
};

}  // namespace lumibox::app
