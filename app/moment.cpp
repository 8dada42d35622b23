#include "app/moment.h"

#include <memory>
#include <utility>

namespace lumibox::app {

lightfield::Perspective perspective_of(const Moment& moment,
                                       std::shared_ptr<const geometry::Camera> camera) {
  lightfield::Perspective perspective;
  perspective.world_from_camera = *moment.tracked.world_from_camera;
  perspective.timestamp_ns = moment.frame.timestamp_ns;
  perspective.photo = std::make_shared<lightfield::Photo>(moment.frame.color);
  perspective.camera = std::move(camera);
  perspective.keyframe = moment.tracked.keyframe;
  perspective.keyframe_from_camera = moment.tracked.keyframe_from_camera;
  return perspective;
}

}  // namespace lumibox::app
