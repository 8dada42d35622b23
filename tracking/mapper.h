#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/initialiser.h"
#include "tracking/loop_detector.h"
#include "tracking/map.h"
#include "tracking/map_view.h"
#include "tracking/tracker.h"

namespace lumibox::tracking {

/// What the tracker learnt about a point in one frame.
struct PointEvidence {
  PointId point = -1;
  bool found = false;
};

/// A frame that the tracker wants to become a keyframe.
struct KeyframeRequest {
  KeyframeId reference = -1;  ///< keyframe its pose is relative to, so that corrections move it
  geometry::Pose reference_from_camera;  ///< see TrackedFrame::keyframe_from_camera
  geometry::Vector6d readout_twist = geometry::Vector6d::Zero();  ///< see geometry::FramePose
  std::shared_ptr<const Pyramid> pyramid;
  std::vector<std::pair<PointId, Sighting>> sightings;  ///< their keyframe is set by the mapper
  std::vector<PointEvidence> evidence;                  ///< since the last request
};

/// Makes and corrects the map, on a thread of its own or in turn with the tracker (Klein and
/// Murray, ISMAR 2007, section 6). Publishes a copy of the map after every change.
class Mapper {
 public:
  Mapper(const geometry::Camera& camera, const config::Tracking& options, Mapping mapping);
  ~Mapper();
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  /// The first map, made before the call returns. There must be none yet.
  void start(const InitialMap& initial);

  /// Goes on with a map of before. There must be none yet.
  void resume(const MapView& saved);

  /// In lockstep the map has changed when this returns.
  void request(KeyframeRequest request);

  /// Says that no keyframe is coming for a while: a map that has changed since is adjusted as a
  /// whole, until one does come. In lockstep it is when this returns.
  void rest();

  /// True while requests wait or are worked on.
  bool busy() const;

  /// The newest published copy; null before start() or resume().
  std::shared_ptr<const MapView> view() const;

  /// Works off all requests, then adjusts the whole map.
  void finish();

  /// The exception that ended mapping; none if all is well. Afterwards requests are ignored, and
  /// view() stays what it was.
  std::optional<std::string> error() const;

 private:
  void run();
  void attempt(const std::function<void()>& work);
  void integrate(const KeyframeRequest& request);
  bool close_loop_at(KeyframeId id, std::size_t min_ties);
  void settle();
  void adjust_finally();
  void weigh(const std::vector<PointEvidence>& evidence);
  void publish();

  const geometry::Camera camera_;
  const config::Tracking options_;
  const Mapping mapping_;

  Map map_;  // touched only by whoever runs the mapper
  LoopDetector loops_;
  int loops_closed_ = 0;
  KeyframeId last_loop_ = 0;  ///< keyframe at which one closed
  bool settled_ = true;       ///< adjusted as a whole since the last keyframe
  std::uint64_t revision_ = 0;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<KeyframeRequest> requests_;
  bool integrating_ = false;
  bool settling_ = false;
  bool resting_ = false;  ///< settle() is to be called once no request waits
  bool finishing_ = false;
  bool stopping_ = false;
  std::shared_ptr<const MapView> view_;
  std::optional<std::string> error_;

  std::thread thread_;
};

}  // namespace lumibox::tracking
