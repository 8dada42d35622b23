#include "tracking/mapper.h"

#include <algorithm>
#include <utility>

#include "config/log.h"
#include "config/step_back.h"
#include "tracking/covisibility.h"
#include "tracking/keyframe_culling.h"
#include "tracking/loop_closing.h"
#include "tracking/map_adjustment.h"
#include "tracking/point_creation.h"

namespace lumibox::tracking {
namespace {

constexpr int kTrialFrames = 20;  // searches before a point's record counts
constexpr double kMinFoundShare = 0.25;
constexpr std::size_t kMinTies = 3;      // keyframes that must agree on a loop
constexpr std::size_t kMinLastTies = 2;  // where no others follow
constexpr KeyframeId kLoopKeyframes = 10;
constexpr KeyframeId kLastKeyframes = 3;

}  // namespace

Mapper::Mapper(const geometry::Camera& camera, const config::Tracking& options, Mapping mapping)
    : camera_(camera), options_(options), mapping_(mapping), loops_(camera, options) {
  if (mapping_ == Mapping::Threaded) thread_ = std::thread([this] { run(); });
}

Mapper::~Mapper() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Mapper::start(const InitialMap& initial) {
  const KeyframeId first =
      map_.add_keyframe({geometry::Pose(), initial.first_readout_twist}, initial.first);
  const KeyframeId second =
      map_.add_keyframe({initial.second_from_first, initial.second_readout_twist}, initial.second);
  for (const InitialMap::Point& p : initial.points) {
    const PointId id = map_.add_point(p.position);
    map_.add_sighting(id, {first, p.first_pixel, p.level});
    map_.add_sighting(id, {second, p.second_pixel, p.level});
  }
  map_.update_depths();
  adjust_globally(camera_, options_, map_);
  create_points(camera_, options_, map_, second);
  adjust_globally(camera_, options_, map_);
  if (map_.keyframe(first).median_depth > 0.0) map_.scale(1.0 / map_.keyframe(first).median_depth);
  publish();
}

void Mapper::resume(const MapView& saved) {
  map_ = Map(saved);
  revision_ = saved.revision;
  publish();
}

void Mapper::request(KeyframeRequest request) {
  if (mapping_ == Mapping::Lockstep) {
    attempt([&] { integrate(request); });
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    requests_.push_back(std::move(request));
  }
  changed_.notify_all();
}

void Mapper::rest() {
  if (mapping_ == Mapping::Lockstep) {
    attempt([this] { settle(); });
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    resting_ = true;
  }
  changed_.notify_all();
}

bool Mapper::busy() const {
  const std::lock_guard lock(mutex_);
  return integrating_ || !requests_.empty();
}

std::shared_ptr<const MapView> Mapper::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

void Mapper::finish() {
  {
    std::unique_lock lock(mutex_);
    finishing_ = true;
    changed_.wait(lock, [this] { return requests_.empty() && !integrating_ && !settling_; });
  }
  if (view()) attempt([this] { adjust_finally(); });
  const std::lock_guard lock(mutex_);
  finishing_ = resting_ = false;
}

void Mapper::adjust_finally() {
  // The last keyframes may have come back to where others began, and none come to confirm it.
  const auto newest = static_cast<KeyframeId>(map_.keyframes().size()) - 1;
  for (KeyframeId id = newest; id > std::max(newest - kLastKeyframes, 0); --id) {
    if (close_loop_at(id, kMinLastTies)) break;
  }
  // Twice: the second pass no longer has the outliers that the first removed.
  adjust_globally(camera_, options_, map_);
  adjust_globally(camera_, options_, map_);
  settled_ = true;
  publish();
}

std::optional<std::string> Mapper::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void Mapper::run() {
  config::give_way("the map is made");
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock,
                  [this] { return stopping_ || !requests_.empty() || (resting_ && !finishing_); });
    if (stopping_) return;
    if (!requests_.empty()) {
      std::optional<KeyframeRequest> request = std::move(requests_.front());
      requests_.pop_front();
      integrating_ = true;
      lock.unlock();
      attempt([&] { integrate(*request); });
      request.reset();  // with its picture, before anybody waits for the lock
      lock.lock();
      integrating_ = false;
    } else {
      resting_ = false;
      settling_ = true;
      lock.unlock();
      attempt([this] { settle(); });
      lock.lock();
      settling_ = false;
      if (!settled_ && !error_) resting_ = true;  // interrupted: goes on when it can
    }
    changed_.notify_all();
  }
}

/// An exception leaves map_ half changed: it is not touched again. What is published stays whole.
void Mapper::attempt(const std::function<void()>& work) {
  if (error()) return;
  try {
    work();
  } catch (const std::exception& exception) {
    config::log_error(std::string("mapping ended: ") + exception.what());
    const std::lock_guard lock(mutex_);
    error_ = exception.what();
  }
}

void Mapper::integrate(const KeyframeRequest& request) {
  weigh(request.evidence);
  const KeyframeId id = map_.add_keyframe(
      {(map_.world_from_keyframe(request.reference) * request.reference_from_camera).inverse(),
       request.readout_twist},
      request.pyramid);
  for (auto [point, sighting] : request.sightings) {
    if (!map_.has_point(point)) continue;
    sighting.keyframe = id;
    map_.add_sighting(point, sighting);
  }
  map_.update_depths();
  create_points(camera_, options_, map_, id);
  adjust_locally(camera_, options_, map_, id);
  const bool closed = close_loop_at(id, kMinTies);
  cull_keyframes(options_, map_, id);
  settled_ = false;
  publish();
  if (closed) rest();
}

/// Adjusts the whole map, if it has changed, for as long as no request comes.
void Mapper::settle() {
  if (settled_) return;
  settled_ = adjust_globally(camera_, options_, map_, [this] {
    const std::lock_guard lock(mutex_);
    return stopping_ || finishing_ || !requests_.empty();
  });
  publish();
}

/// Looks whether keyframe `id` shows a place that another part of the map shows too.
bool Mapper::close_loop_at(KeyframeId id, std::size_t min_ties) {
  const CovisibilityGraph graph(map_, kConnected);
  // A tie takes some keyframes to grow: they are one loop.
  bool met = id - last_loop_ >= kLoopKeyframes && has_met_itself(map_, graph, id);
  if (!met) {
    const auto loop = loops_.find(map_, graph, id, min_ties);
    met = loop && close_loop(map_, graph, *loop);
  }
  if (!met) return false;
  ++loops_closed_;
  last_loop_ = id;
  return true;
}

void Mapper::weigh(const std::vector<PointEvidence>& evidence) {
  for (const PointEvidence& e : evidence) {
    if (!map_.has_point(e.point)) continue;
    Map::Point& point = map_.point(e.point);
    ++point.searched;
    if (e.found) ++point.found;
    if (point.searched >= kTrialFrames && point.found < kMinFoundShare * point.searched) {
      map_.remove_point(e.point);
    }
  }
}

void Mapper::publish() {
  auto view = std::make_shared<MapView>(map_.view(++revision_));
  view->loops_closed = loops_closed_;
  std::shared_ptr<const MapView> newest = std::move(view);
  {
    const std::lock_guard lock(mutex_);
    view_.swap(newest);
  }
}  // the one before ends here: thousands of points, for which nobody waits

}  // namespace lumibox::tracking
