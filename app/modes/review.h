#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/modes/mode.h"
#include "render/view.h"

namespace lumibox::app {

/// Thesis 2.4: the light field as it stands, seen through a virtual camera, at once.
class ReviewMode : public Mode {
 public:
  ReviewMode(Session& session, const geometry::Camera& camera)
      : session_(session), view_camera_(camera.undistorted()) {}

  void enter(const Moment& moment) override;
  ModeId press(const Gesture& gesture, const Moment& moment) override;
  ModeId update(const Moment& moment) override;
  Picture draw(const Moment& moment) const override;

 private:
  /// What moves the virtual camera.
  enum class Steering {
    Box,    ///< the pose of the box itself
    Orbit,  ///< nobody: it goes slowly around the subject
    Stand,  ///< nobody: it stands where a picture was taken that disagrees with others
  };

  std::optional<geometry::Pose> pose_of_box(const Moment& moment) const;
  void stand_at_next_disagreeing();
  render::Geometry geometry() const;
  std::vector<lightfield::Perspective> equally_bright_perspectives() const;
  std::string advice(const Moment& moment) const;
  void wipe(Press press);
  void focus_anew();
  Eigen::Vector3d focus() const;

  Session& session_;
  Steering steering_ = Steering::Box;
  render::Aperture aperture_ = render::Aperture::Small;
  int stand_ = -1;                ///< id of the perspective stood at last
  geometry::Camera view_camera_;  ///< of the virtual camera
  /// What the wide aperture was focused on, from S, in world: it goes where S goes.
  Eigen::Vector3d focused_from_subject_ = Eigen::Vector3d::Zero();
  int focus_steps_ = 0;                            ///< away from that, in steps of inverse depth
  std::int64_t orbit_began_ns_ = 0;                ///< Clock time
  std::optional<geometry::Pose> world_from_view_;  ///< the virtual camera
};

}  // namespace lumibox::app
