#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/moment.h"
#include "config/config.h"
#include "geometry/camera.h"
#include "lightfield/capture.h"
#include "lightfield/light_field.h"
#include "lightfield/store.h"
#include "tracking/tracked_frame.h"

namespace lumibox::app {

/// The light field in memory and its folder on disk, kept the same; and both kept where the map is
/// when the map is corrected. A store that fails stops storing, never recording: the error is there
/// to be shown.
class Recorder {
 public:
  /// `camera` is the one whose pictures are recorded.
  Recorder(const geometry::Camera& camera, const config::Capture& options,
           lightfield::Writing writing);
  ~Recorder();

  /// Begins a capture of the subject in `sphere`, kept in `folder`, which is made when the first
  /// perspective is recorded. The capture before, if any, ends with the map of `moment`: its writer
  /// brings it to disk while this one begins. The sphere hangs on the keyframe of `moment`.
  void begin(const lightfield::Sphere& sphere, const Moment& moment, std::filesystem::path folder);

  /// Goes on with a capture that was loaded, in its folder. `map` is the one that was kept with it,
  /// as the tracker goes on in it now: all poses move to where it has them, and what hung on
  /// keyframes that it came too early for hangs on others. Without a map nothing is moved or
  /// recorded any more: there is no telling where these perspectives are in another world.
  void resume(lightfield::Capture capture, const MapNow* map);

  /// Ends the capture under way as begin() does, and begins none.
  void close(const MapNow& map);

  /// Thesis 2.3, with `threshold` in radians: true if the moment's picture should be recorded.
  bool accepts(const Moment& moment, double threshold) const;

  void record(const Moment& moment);

  /// Removes the perspective nearest to `center` by penalty; false if there is none.
  bool wipe_nearest(const Eigen::Vector3d& center);

  /// Removes a perspective; false if there is no such id.
  bool wipe(int id);
  bool undo_wipe();

  /// Moves what the map has moved by more than `tolerance`, a share of the distance to the subject.
  void follow_map(const MapNow& map, double tolerance);

  /// Keeps the map of the moment in the capture's folder if it has changed and that is some time
  /// ago: the capture can be gone on with in it.
  void keep_map(const Moment& moment);

  /// Keeps the gate's threshold (radians) for whoever goes on with the capture.
  void set_threshold(double threshold);

  /// Ends the capture after the last correction of the map, and waits until all captures are on
  /// disk: poses, the map's points, pictures. Throws config::InputError if something of any of them
  /// could not be written.
  void finish(const MapNow& map);

  const lightfield::LightField& light_field() const { return light_field_; }

  /// What went wrong with storing this capture, or else one before it, for the screen.
  std::optional<std::string> error() const;

 private:
  void open_store();
  void keep_map(const MapNow& map);
  void end_capture(const MapNow& map);
  void refine(const MapNow& map);
  void follow_subject(const MapNow& map, double tolerance);

  std::shared_ptr<const geometry::Camera> camera_;
  config::Capture options_;
  lightfield::Writing writing_;
  std::filesystem::path folder_;
  lightfield::LightField light_field_;
  std::unique_ptr<lightfield::Store> store_;
  /// Of captures before: those whose writer is still at work or has failed.
  std::vector<std::unique_ptr<lightfield::Store>> ended_stores_;
  std::optional<std::string> open_error_;
  std::optional<std::uint64_t> map_revision_;  ///< that all poses agree with; none: to be checked
  /// Of the perspectives recorded here, by id.
  std::map<int, tracking::FrameMeasurements> measurements_;
  bool in_this_world_ = true;  ///< the capture's world is the tracker's
  std::optional<double> threshold_;
  std::optional<std::uint64_t> kept_revision_;  ///< of the map on disk
  std::int64_t kept_at_ns_ = 0;                 ///< time of its frame
};

}  // namespace lumibox::app
