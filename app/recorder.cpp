#include "app/recorder.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "config/error.h"
#include "config/log.h"

namespace lumibox::app {

using lightfield::LightField;
using lightfield::Perspective;
using lightfield::Sphere;

namespace {

/// Keyframe of the map nearest to `place` in world.
tracking::KeyframeId nearest_keyframe(const tracking::MapView& map, const Eigen::Vector3d& place) {
  const auto distance = [&place](const tracking::MapView::Keyframe& keyframe) {
    return keyframe.culled() ? std::numeric_limits<double>::infinity()
                             : (keyframe.world_from_camera.translation - place).squaredNorm();
  };
  const auto nearest = std::ranges::min_element(map.keyframes, {}, distance);
  return static_cast<tracking::KeyframeId>(nearest - map.keyframes.begin());
}

/// The same light field, hung on keyframes of the map. Between the last time that a map is kept and
/// the end of the power a capture goes on to hang on newer keyframes; those do not come back, and
/// other ones will have their numbers.
LightField hung_on(const tracking::MapView& map, const LightField& light_field) {
  const auto exists = [&map](int id) {
    return id >= 0 && static_cast<std::size_t>(id) < map.keyframes.size();
  };
  const auto keyframe_from_world = [&map](int id) {
    return map.keyframes[static_cast<std::size_t>(id)].world_from_keyframe().inverse();
  };
  std::vector<Perspective> perspectives = light_field.perspectives();
  for (Perspective& p : perspectives) {
    if (!exists(p.keyframe)) {
      p.keyframe = nearest_keyframe(map, p.center());
      p.keyframe_from_camera = keyframe_from_world(p.keyframe) * p.world_from_camera;
    }
  }
  std::optional<Sphere> subject = light_field.subject();
  if (subject && !exists(subject->keyframe)) {
    subject->keyframe = nearest_keyframe(map, subject->center);
    subject->center_in_keyframe = keyframe_from_world(subject->keyframe) * subject->center;
  }
  return {std::move(perspectives), subject};
}

}  // namespace

Recorder::Recorder(const geometry::Camera& camera, const config::Capture& options,
                   lightfield::Writing writing)
    : camera_(std::make_shared<geometry::Camera>(camera)), options_(options), writing_(writing) {}

Recorder::~Recorder() = default;

void Recorder::begin(const Sphere& sphere, const Moment& moment, std::filesystem::path folder) {
  end_capture(moment.map);
  open_error_.reset();
  folder_ = std::move(folder);
  light_field_ = lightfield::LightField{};
  map_revision_ = moment.map.revision;
  Sphere subject = sphere;
  if (const auto world_from_keyframe = moment.map.world_from_keyframe(moment.tracked.keyframe)) {
    subject.keyframe = moment.tracked.keyframe;
    subject.center_in_keyframe = world_from_keyframe->inverse() * sphere.center;
  }
  light_field_.set_subject(subject);
}

void Recorder::resume(lightfield::Capture capture, const MapNow* map) {
  const auto kept = map != nullptr ? map->copy() : nullptr;
  if (kept) {
    capture.light_field = hung_on(*kept, capture.light_field);
    kept_revision_ = map->revision;
  }
  in_this_world_ = kept != nullptr;
  map_revision_.reset();
  folder_ = capture.folder;
  threshold_ = capture.threshold;
  light_field_ = capture.light_field;
  store_ = std::make_unique<lightfield::Store>(capture, kept ? kept->keyframes.size() : 0,
                                               options_.jpeg_quality, writing_);
}

void Recorder::close(const MapNow& map) {
  end_capture(map);
  light_field_ = lightfield::LightField{};
}

bool Recorder::accepts(const Moment& moment, double threshold) const {
  return moment.tracking_is_good() &&
         light_field_.accepts(moment.tracked.world_from_camera->translation, threshold);
}

void Recorder::record(const Moment& moment) {
  Perspective perspective = perspective_of(moment, camera_);
  perspective.id = light_field_.add(perspective);
  if (moment.measurements != nullptr) {
    measurements_[perspective.id] = *moment.measurements;
  }
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
    if (threshold_) {
      store_->set_threshold(*threshold_);
    }
  } catch (const config::InputError& error) {
    open_error_ = error.what();
    config::log_error(error.what());
  }
}

bool Recorder::wipe_nearest(const Eigen::Vector3d& center) {
  const std::optional<int> id = light_field_.nearest(center);
  return id && wipe(*id);
}

bool Recorder::wipe(int id) {
  if (!light_field_.wipe(id)) {
    return false;
  }
  if (store_) {
    store_->remove(id);
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
  if (map.revision == map_revision_ || !light_field_.subject() || !in_this_world_) {
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
  Sphere sphere = *light_field_.subject();
  const auto world_from_keyframe = map.world_from_keyframe(sphere.keyframe);
  if (!world_from_keyframe) {
    return;
  }
  const Eigen::Vector3d center = *world_from_keyframe * sphere.center_in_keyframe;
  if ((center - sphere.center).norm() <= tolerance * sphere.radius) {
    return;
  }
  sphere.center = center;
  light_field_.set_subject(sphere);
  if (store_) {
    store_->set_subject(sphere);
  }
}

void Recorder::keep_map(const Moment& moment) {
  const auto interval_ns = static_cast<std::int64_t>(1e9 * options_.map_interval_s);
  if (!kept_revision_ || moment.frame.timestamp_ns - kept_at_ns_ >= interval_ns) {
    kept_at_ns_ = moment.frame.timestamp_ns;
    keep_map(moment.map);
  }
}

void Recorder::keep_map(const MapNow& map) {
  if (!store_ || !in_this_world_ || map.revision == kept_revision_) {
    return;
  }
  if (auto copy = map.copy()) {
    kept_revision_ = map.revision;
    store_->set_map(std::move(copy), camera_);
  }
}

void Recorder::set_threshold(double threshold) {
  if (threshold != threshold_ && store_) {
    store_->set_threshold(threshold);
  }
  threshold_ = threshold;
}

void Recorder::end_capture(const MapNow& map) {
  std::erase_if(ended_stores_, [](const auto& store) { return store->ended() && !store->error(); });
  map_revision_.reset();  // moves that were too small so far count now
  follow_map(map, 0.0);
  refine(map);
  if (store_) {
    if (in_this_world_) {
      store_->set_points(map.points());
      keep_map(map);
    }
    store_->end();
    ended_stores_.push_back(std::move(store_));
  }
  measurements_.clear();
  kept_revision_.reset();
  in_this_world_ = true;
}

/// The pose of a live frame is good to what the map was then. Estimated again from the same pixels
/// and the points where they are now, it has the errors of one picture alone, not those of the map
/// of then.
void Recorder::refine(const MapNow& map) {
  const auto copy = in_this_world_ && !measurements_.empty() ? map.copy() : nullptr;
  if (!copy) {
    return;
  }
  const std::vector<Perspective> perspectives = light_field_.perspectives();
  for (const Perspective& p : perspectives) {
    const auto measured = measurements_.find(p.id);
    const auto world_from_keyframe = map.world_from_keyframe(p.keyframe);
    if (measured == measurements_.end() || !world_from_keyframe) {
      continue;
    }
    const auto refined =
        tracking::refine_pose(*camera_, *copy, measured->second, p.world_from_camera);
    if (!refined) {
      continue;
    }
    const geometry::Pose keyframe_from_camera = world_from_keyframe->inverse() * *refined;
    light_field_.hang(p.id, p.keyframe, keyframe_from_camera);
    if (store_) {
      store_->hang(p.id, p.keyframe, keyframe_from_camera);
    }
  }
  map_revision_.reset();
  follow_map(map, 0.0);
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

}  // namespace lumibox::app
