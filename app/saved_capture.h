#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "geometry/camera.h"
#include "lightfield/capture.h"
#include "lightfield/capture_lock.h"
#include "tracking/map_view.h"

namespace lumibox::app {

/// A capture on disk that one may go on with.
struct SavedCapture {
  lightfield::Capture capture;
  std::shared_ptr<const tracking::MapView> map;  ///< kept with it; null if there is a problem
  std::optional<lightfield::CaptureLock> lock;   ///< held if it is to be gone on with
  std::string problem;                           ///< why it cannot be gone on with; empty: it can

  std::string name() const { return capture.folder.filename().string(); }
};

/// The capture in `folder`, as this camera can go on with it; pyramids of the map have `levels`
/// levels. Throws config::InputError if it is none; a map that is missing or damaged is a problem
/// in the result: the capture can still be looked at.
SavedCapture load_saved_capture(const std::filesystem::path& folder, const geometry::Camera& camera,
                                int levels);

/// The last capture in `captures`, with its lock; none if there is none with anything in it. One
/// that cannot be loaded is said in the log and left alone; so is why one cannot be gone on with.
/// Throws lightfield::CaptureInUse if another process records into it.
std::optional<SavedCapture> find_saved_capture(const std::filesystem::path& captures,
                                               const geometry::Camera& camera, int levels);

/// Folder of a new capture in `captures`: capture-0001, capture-0002, …, one more than the last.
std::filesystem::path next_capture_folder(const std::filesystem::path& captures);

}  // namespace lumibox::app
