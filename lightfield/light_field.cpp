#include "lightfield/light_field.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "geometry/rotation.h"

namespace lumibox::lightfield {
namespace {

bool id_below(const Perspective& perspective, int id) {
  return perspective.id < id;
}

/// Iterator to the perspective with this id, or end.
auto find_id(std::vector<Perspective>& ascending, int id) {
  const auto found = std::lower_bound(ascending.begin(), ascending.end(), id, id_below);
  return found != ascending.end() && found->id == id ? found : ascending.end();
}

}  // namespace

double angle_at_subject(const Eigen::Vector3d& a, const Eigen::Vector3d& subject,
                        const Eigen::Vector3d& b) {
  return geometry::angle_between(a - subject, b - subject);
}

LightField::LightField(std::vector<Perspective> perspectives, std::optional<Sphere> subject)
    : perspectives_(std::move(perspectives)), subject_(std::move(subject)) {
  std::sort(perspectives_.begin(), perspectives_.end(),
            [](const Perspective& a, const Perspective& b) { return a.id < b.id; });
  if (!perspectives_.empty()) next_id_ = perspectives_.back().id + 1;
}

bool LightField::accepts(const Eigen::Vector3d& center, double threshold) const {
  if (!subject_ || !center.allFinite()) return false;
  const Eigen::Vector3d& subject = subject_->center;
  if (center == subject) return false;
  return std::all_of(perspectives_.begin(), perspectives_.end(), [&](const Perspective& recorded) {
    return recorded.center() == subject ||
           angle_at_subject(center, subject, recorded.center()) > threshold;
  });
}

int LightField::add(Perspective perspective) {
  perspective.id = next_id_++;
  perspectives_.push_back(std::move(perspective));
  ++revision_;
  return perspectives_.back().id;
}

std::optional<int> LightField::nearest(const Eigen::Vector3d& center) const {
  if (perspectives_.empty()) return std::nullopt;
  const auto order = [&](const Perspective& perspective) {
    const double penalty =
        subject_ ? angle_at_subject(center, subject_->center, perspective.center()) : 0.0;
    return std::tuple(penalty, (perspective.center() - center).norm(), perspective.id);
  };
  const auto closest = std::min_element(
      perspectives_.begin(), perspectives_.end(),
      [&](const Perspective& a, const Perspective& b) { return order(a) < order(b); });
  return closest->id;
}

std::optional<Perspective> LightField::wipe(int id) {
  const auto found = find_id(perspectives_, id);
  if (found == perspectives_.end()) return std::nullopt;
  wiped_.push_back(std::move(*found));
  perspectives_.erase(found);
  ++revision_;
  return wiped_.back();
}

std::optional<Perspective> LightField::undo_wipe() {
  if (wiped_.empty()) return std::nullopt;
  Perspective perspective = std::move(wiped_.back());
  wiped_.pop_back();
  const auto place =
      std::lower_bound(perspectives_.begin(), perspectives_.end(), perspective.id, id_below);
  ++revision_;
  return *perspectives_.insert(place, std::move(perspective));
}

std::optional<std::string> LightField::lost_pictures() const {
  std::size_t lost = 0;
  std::string first;
  for (const Perspective& perspective : perspectives_) {
    const auto fault = perspective.photo ? perspective.photo->fault() : std::nullopt;
    if (fault && ++lost == 1) first = *fault;
  }
  if (lost == 0) return std::nullopt;
  return std::to_string(lost) + " of " + std::to_string(perspectives_.size()) +
         " pictures are lost: " + first;
}

Perspective* LightField::find(int id) {
  for (auto* among : {&perspectives_, &wiped_}) {
    const auto found = std::ranges::find(*among, id, &Perspective::id);
    if (found != among->end()) return &*found;
  }
  return nullptr;
}

bool LightField::set_pose(int id, const geometry::Pose& world_from_camera) {
  Perspective* const perspective = find(id);
  if (perspective == nullptr) return false;
  perspective->world_from_camera = world_from_camera;
  ++revision_;
  return true;
}

bool LightField::hang(int id, int keyframe, const geometry::Pose& keyframe_from_camera) {
  Perspective* const perspective = find(id);
  if (perspective == nullptr) return false;
  perspective->keyframe = keyframe;
  perspective->keyframe_from_camera = keyframe_from_camera;
  ++revision_;
  return true;
}

}  // namespace lumibox::lightfield
