#include "app/aperture.h"

#include <algorithm>
#include <numbers>

#include "lightfield/light_field.h"

namespace lumibox::app {

using lightfield::Perspective;

Aperture::Aperture(const geometry::Camera& camera, const config::Aperture& options)
    : camera_(std::make_shared<geometry::Camera>(camera)), options_(options) {}

void Aperture::update(const Moment& moment, const Eigen::Vector3d& focus) {
  for (Perspective& kept : kept_) {
    if (const auto world_from_keyframe = moment.map.world_from_keyframe(kept.keyframe)) {
      kept.world_from_camera = *world_from_keyframe * kept.keyframe_from_camera;
    }
  }
  if (moment.frame.color != live_) {
    live_ = moment.frame.color;
    live_photo_ = std::make_shared<lightfield::Photo>(live_);
  }
  if (!moment.tracking_is_good()) {
    return;
  }
  const Eigen::Vector3d& center = moment.tracked.world_from_camera->translation;
  const double gate = options_.gate_deg * std::numbers::pi / 180.0;
  const bool is_new = std::ranges::all_of(kept_, [&](const Perspective& kept) {
    return lightfield::angle_at_subject(center, focus, kept.center()) > gate;
  });
  if (!is_new) {
    return;
  }
  if (frames() == options_.frames) {
    kept_.erase(kept_.begin());
  }
  kept_.push_back(with_id(moment, next_id_--));
}

LightFieldPicture Aperture::draw(const Moment& moment, const Eigen::Vector3d& focus,
                                 const config::Render& options) const {
  LightFieldPicture picture;
  picture.perspectives = kept_;
  picture.perspectives.push_back(with_id(moment, next_id_));
  picture.settings = render::augmented_settings_from(options, focus);
  picture.settings.k = static_cast<int>(picture.perspectives.size());
  return picture;
}

Perspective Aperture::with_id(const Moment& moment, int id) const {
  Perspective perspective = perspective_of(moment, camera_);
  perspective.photo = live_photo_;
  perspective.id = id;
  return perspective;
}

}  // namespace lumibox::app
