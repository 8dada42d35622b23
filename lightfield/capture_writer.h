#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lightfield/capture.h"
#include "lightfield/capture_lock.h"
#include "lightfield/durable_files.h"
#include "lightfield/map_files.h"
#include "lightfield/perspective.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {

/// Writes a capture folder as it is recorded, in the calling thread: pictures at once,
/// transforms.json by commit(). All functions throw config::InputError; the folder then holds the
/// capture as of the last successful commit. No other process can write it meanwhile (CaptureLock).
class CaptureWriter {
 public:
  /// Makes the folder with an empty capture in it.
  CaptureWriter(std::filesystem::path folder, int jpeg_quality, DurableFiles files);

  /// Goes on with the capture that is in capture.folder already, and with the first `keyframes`
  /// keyframes of the map there. Writes nothing yet; the first commit after any change writes what
  /// `capture` says.
  CaptureWriter(const Capture& capture, std::size_t keyframes, int jpeg_quality,
                DurableFiles files);

  void add(const Perspective& perspective);
  void remove(int id);
  void restore(const Perspective& perspective);
  void set_points(const std::vector<Eigen::Vector3d>& points);

  /// Writes the map, after what perspectives hang on in it. What goes wrong with the map alone is
  /// returned, as a sentence with the path: the data set is as good without it, and goes on.
  std::optional<std::string> set_map(const tracking::MapView& map, const geometry::Camera& camera);

  /// Waits for the next commit, as moves do.
  void set_threshold(double radians);

  /// Moves, of which a correction of the map makes many, wait for the next commit after a change
  /// of another kind; no commit ever writes a part of them.
  void set_subject(const Sphere& sphere);
  void set_pose(int id, const geometry::Pose& world_from_camera);

  void hang(int id, int keyframe, const geometry::Pose& keyframe_from_camera);

  /// Brings transforms.json up to date if something but moves has changed.
  void commit();
  /// The same, if only moves have, too.
  void commit_moves();

  /// Removes the pictures that the transforms.json on disk does not name.
  void remove_unnamed_pictures();

  /// Lets others write the folder: nothing more will be written here.
  void unlock();

  const std::filesystem::path& folder() const { return folder_; }

 private:
  void put(const Perspective& perspective, std::string file);

  std::filesystem::path folder_;
  int jpeg_quality_;
  DurableFiles files_;
  std::optional<CaptureLock> lock_;
  MapWriter map_;
  std::map<int, Perspective> named_;  ///< by id, without their pictures
  TransformsHeader header_;
  bool changed_ = false;                 ///< there is something that commit() must write
  bool moved_ = false;                   ///< there are moves that wait for it
  std::set<std::string> pictures_;       ///< written in this capture
  std::set<std::string> named_on_disk_;  ///< by the transforms.json on disk
};

}  // namespace lumibox::lightfield
