#include "tracking/motion_model.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace lumibox::tracking {
namespace {

constexpr double kMinIntervalS = 1e-3;  // against times that stand still
constexpr double kMaxIntervalS = 0.2;   // a hand does not go on as it did for longer
constexpr double kAgreement = 1.5 * std::numbers::pi / 180.0;

}  // namespace

void MotionModel::next_frame(const Pyramid& picture, std::int64_t timestamp_ns) {
  std::swap(last_, current_);
  current_.assign(picture);
  interval_s_ = std::clamp(1e-9 * static_cast<double>(timestamp_ns - timestamp_ns_), kMinIntervalS,
                           kMaxIntervalS);
  timestamp_ns_ = timestamp_ns;
}

geometry::Pose MotionModel::expect(const geometry::Pose& last_from_world) const {
  return geometry::exp_se3(interval_s_ * velocity_.value_or(geometry::Vector6d::Zero())) *
         last_from_world;
}

geometry::Pose MotionModel::current_from_last() const {
  const geometry::Pose steady = expect({});
  const RotationPrior prior = estimate_rotation(camera_, last_, current_);
  const double disagreement = prior.current_from_last.angularDistance(steady.rotation);
  if (prior.residual < 1e8 && disagreement > kAgreement) {
    return {prior.current_from_last, Eigen::Vector3d::Zero()};
  }
  return steady;
}

geometry::FramePose MotionModel::predict(const geometry::Pose& last_from_world) const {
  const geometry::Pose motion = current_from_last();
  return {motion * last_from_world,
          camera_.profile().readout_s / interval_s_ * geometry::log_se3(motion)};
}

geometry::Vector6d MotionModel::readout_twist(const geometry::Pose& last_from_world,
                                              const geometry::Pose& current_from_world) const {
  const geometry::Vector6d mean =
      geometry::log_se3(current_from_world * last_from_world.inverse()) / interval_s_;
  const geometry::Vector6d change = mean - velocity_.value_or(mean);
  return camera_.profile().readout_s * (mean + 0.5 * change);
}

void MotionModel::moved(const geometry::Pose& last_from_world,
                        const geometry::Pose& current_from_world) {
  velocity_ = geometry::log_se3(current_from_world * last_from_world.inverse()) / interval_s_;
}

}  // namespace lumibox::tracking
