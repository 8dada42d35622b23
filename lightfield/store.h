#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lightfield/capture.h"
#include "lightfield/durable_files.h"
#include "lightfield/light_field.h"
#include "tracking/map_view.h"

namespace lumibox::lightfield {

/// Who writes.
enum class Writing {
  Inline,    ///< the caller, before the call returns: lockstep
  Threaded,  ///< a thread of its own: a recorded perspective costs the loop no file access
};

/// A capture on disk, written as it is recorded. At every instant the folder holds a
/// transforms.json that is a valid nerfstudio data set: pictures are written and synced before a
/// transforms.json that names them; that is written aside, synced, renamed, and its folder synced.
/// Both ways of writing leave the same bytes. Until all that end() asked for is done no other
/// process can write the folder.
class Store {
 public:
  /// Creates `folder`, or opens it if empty. Refuses (config::InputError) a folder that already
  /// holds something, or that another process has: nothing recorded is ever overwritten.
  Store(const std::filesystem::path& folder, int jpeg_quality, Writing writing,
        DurableFiles files = {});

  /// Goes on with a capture that was loaded, in capture.folder, and with the first `keyframes`
  /// keyframes of the map there (0 if the map there is not gone on with). Nothing is written before
  /// something changes. Whoever loads it takes the CaptureLock first. Throws config::InputError if
  /// another process has the folder.
  Store(const Capture& capture, std::size_t keyframes, int jpeg_quality, Writing writing,
        DurableFiles files = {});

  /// end(), and waits for it.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Each returns at once when Threaded. Perspectives come with the id that their LightField gave
  /// them, picture and camera. The pictures of wiped ones stay on disk, unnamed, until end(),
  /// so that undo finds them.
  void add(const Perspective& perspective);
  void remove(int id);
  void restore(const Perspective& perspective);
  void set_points(std::vector<Eigen::Vector3d> points);

  /// Keeps the map that the poses are in. Of several that wait the newest alone is written.
  void set_map(std::shared_ptr<const tracking::MapView> map,
               std::shared_ptr<const geometry::Camera> camera);

  /// A correction of the map moves the sphere and many perspectives at once: moves are written
  /// together, with the next change of another kind or flush(). Unknown ids are ignored.
  void set_subject(const Sphere& sphere);
  void set_pose(int id, const geometry::Pose& world_from_camera);

  /// Has a perspective hang on a keyframe in another way. Written as moves are.
  void hang(int id, int keyframe, const geometry::Pose& keyframe_from_camera);

  /// Of the gate, radians. Written as moves are.
  void set_threshold(double radians);

  /// First error of the writer (disk full, folder gone), as a sentence with the path; none if all
  /// is well. After an error nothing more is written: what was complete before stays loadable. Only
  /// one with the map ends nothing: the map before stays, and the next is tried.
  std::optional<std::string> error() const;

  /// Waits until everything handed over is on disk. Throws config::InputError on error().
  void flush();

  /// Writes what is left, then removes the pictures of wiped perspectives; returns at once when
  /// Threaded. Nothing may be changed any more.
  void end();

  /// True once all that end() asked for is done, or has failed: destruction no longer waits.
  bool ended() const;

  const std::filesystem::path& folder() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::lightfield
