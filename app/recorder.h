#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/moment.h"
#include "config/config.h"
#include "geometry/camera.h"
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

  /// Thesis 2.3, with `threshold` in radians: true if the moment's picture should be recorded.
  bool accepts(const Moment& moment, double threshold) const;

  void record(const Moment& moment);

  /// Removes the perspective nearest to `center` by penalty; false if there is none.
  bool wipe_nearest(const Eigen::Vector3d& center);
  bool undo_wipe();

  /// Moves what the map has moved by more than `tolerance`, a share of the distance to the subject.
  void follow_map(const MapNow& map, double tolerance);

  /// Ends the capture after the last correction of the map, and waits until all captures are on
  /// disk: poses, the map's points, pictures. Throws config::InputError if something of any of them
  /// could not be written.
  void finish(const MapNow& map);

  const lightfield::LightField& light_field() const { return light_field_; }

  /// What went wrong with storing this capture, or else one before it, for the screen.
  std::optional<std::string> error() const;

 private:
  void open_store();
  void end_capture(const MapNow& map);
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
  tracking::KeyframeId subject_keyframe_ = -1;
  Eigen::Vector3d subject_in_keyframe_ = Eigen::Vector3d::Zero();
};

/// Folder of a new capture in `captures`: capture-0001, capture-0002, …, the first that is not
/// there.
std::filesystem::path next_capture_folder(const std::filesystem::path& captures);

}  // namespace lumibox::app
