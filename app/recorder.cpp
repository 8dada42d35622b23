#include "app/recorder.h"

#include <cstddef>
#include <utility>

#include "config/error.h"
#include "config/log.h"

namespace lumibox::app {

using lightfield::Perspective;
using lightfield::Sphere;

Recorder::Recorder(const geometry::Camera& camera, const config::Capture& options,
                   lightfield::Writing writing)
    : camera_(std::make_shared<geometry::Camera>(camera)), options_(options), writing_(writing) {}

Recorder::~Recorder() = default;

void Recorder::begin(const Sphere& sphere, const Moment& moment, std::filesystem::path folder) {
  end_capture(moment.map);
  open_error_.reset();
  folder_ = std::move(folder);
  light_field_ = lightfield::LightField{};
  light_field_.set_subject(sphere);
  map_revision_ = moment.map.revision;
  subject_keyframe_ = moment.tracked.keyframe;
  if (const auto world_from_keyframe = moment.map.world_from_keyframe(subject_keyframe_)) {
    subject_in_keyframe_ = world_from_keyframe->inverse() * sphere.center;
  } else {
    subject_keyframe_ = -1;
  }
}

bool Recorder::accepts(const Moment& moment, double threshold) const {
  return moment.tracking_is_good() &&
         light_field_.accepts(moment.tracked.world_from_camera->translation, threshold);
}

void Recorder::record(const Moment& moment) {
  Perspective perspective;
  perspective.world_from_camera = *moment.tracked.world_from_camera;
  perspective.timestamp_ns = moment.frame.timestamp_ns;
  perspective.color = moment.frame.color;
  perspective.camera = camera_;
  perspective.keyframe = moment.tracked.keyframe;
  perspective.keyframe_from_camera = moment.tracked.keyframe_from_camera;
  perspective.id = light_field_.add(perspective);
  if (!store_ && !open_error_) {
    open_store();
  }
  if (store_) {
    store_->add(perspective);
  }
}

void Recorder::open_store() {
  try {
    store_ = std::make_unique<lightfield::Store>(folder_, options_.jpeg_quality, writing_);
    store_->set_subject(*light_field_.subject());
  } catch (const config::InputError& error) {
    open_error_ = error.what();
    config::log_error(error.what());
  }
}

bool Recorder::wipe_nearest(const Eigen::Vector3d& center) {
  const std::optional<int> id = light_field_.nearest(center);
  if (!id) {
    return false;
  }
  light_field_.wipe(*id);
  if (store_) {
    store_->remove(*id);
  }
  return true;
}

bool Recorder::undo_wipe() {
  const std::optional<Perspective> perspective = light_field_.undo_wipe();
  if (perspective && store_) {
    store_->restore(*perspective);
  }
  map_revision_.reset();  // the map may have moved while it was away
  return perspective.has_value();
}

void Recorder::follow_map(const MapNow& map, double tolerance) {
  if (map.revision == map_revision_ || !light_field_.subject()) {
    return;
  }
  map_revision_ = map.revision;
  follow_subject(map, tolerance);
  const Eigen::Vector3d subject = light_field_.subject()->center;
  struct Move {
    int id;
    geometry::Pose world_from_camera;
  };
  std::vector<Move> moves;  // set_pose() changes what perspectives() refers to
  for (const Perspective& perspective : light_field_.perspectives()) {
    const auto world_from_keyframe = map.world_from_keyframe(perspective.keyframe);
    if (!world_from_keyframe) {
      continue;
    }
    const geometry::Pose moved = *world_from_keyframe * perspective.keyframe_from_camera;
    const double distance = (perspective.center() - subject).norm();
    const double turn = moved.rotation.angularDistance(perspective.world_from_camera.rotation);
    if ((moved.translation - perspective.center()).norm() > tolerance * distance ||
        turn > tolerance) {
      moves.push_back({perspective.id, moved});
    }
  }
  for (const Move& move : moves) {
    light_field_.set_pose(move.id, move.world_from_camera);
    if (store_) {
      store_->set_pose(move.id, move.world_from_camera);
    }
  }
}

void Recorder::follow_subject(const MapNow& map, double tolerance) {
  const auto world_from_keyframe = map.world_from_keyframe(subject_keyframe_);
  if (!world_from_keyframe) {
    return;
  }
  Sphere sphere = *light_field_.subject();
  const Eigen::Vector3d center = *world_from_keyframe * subject_in_keyframe_;
  if ((center - sphere.center).norm() <= tolerance * sphere.radius) {
    return;
  }
  sphere.center = center;
  light_field_.set_subject(sphere);
  if (store_) {
    store_->set_subject(sphere);
  }
}

void Recorder::end_capture(const MapNow& map) {
  std::erase_if(ended_stores_, [](const auto& store) { return store->ended() && !store->error(); });
  map_revision_.reset();  // moves that were too small so far count now
  follow_map(map, 0.0);
  if (!store_) {
    return;
  }
  store_->set_points(map.points());
  store_->end();
  ended_stores_.push_back(std::move(store_));
}

void Recorder::finish(const MapNow& map) {
  end_capture(map);
  if (open_error_) {
    throw config::InputError(*open_error_);
  }
  for (const auto& store : ended_stores_) {
    store->flush();
  }
}

std::optional<std::string> Recorder::error() const {
  if (open_error_) {
    return open_error_;
  }
  if (store_ && store_->error()) {
    return store_->error();
  }
  for (const auto& store : ended_stores_) {
    if (const auto problem = store->error()) {
      return problem;
    }
  }
  return std::nullopt;
}

std::filesystem::path next_capture_folder(const std::filesystem::path& captures) {
  for (int number = 1;; ++number) {
    const std::string digits = std::to_string(number);
    const std::string padding(digits.size() < 4 ? 4 - digits.size() : 0, '0');
    const std::filesystem::path folder = captures / ("capture-" + padding + digits);
    if (std::error_code ignored; !std::filesystem::exists(folder, ignored)) {
      return folder;
    }
  }
}

}  // namespace lumibox::app
