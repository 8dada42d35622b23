#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <vector>

#include "geometry/camera.h"
#include "lightfield/durable_files.h"
#include "tracking/map_view.h"

namespace lumibox::lightfield {

inline constexpr const char* kMapFolder = "map";
inline constexpr const char* kMapFile = "map/map.json";

/// "map/000012.png": where a capture keeps the picture of a map keyframe.
std::string map_picture_file(tracking::KeyframeId id);

/// Keeps the tracker's map in a capture folder, so that the capture can be gone on with after the
/// power has gone (docs/capture-format.md). At every instant the folder holds the map as of the
/// last write that was complete, or none if there was none: pictures, which never change, are
/// written once and before the map.json that names them.
class MapWriter {
 public:
  /// `on_disk`: keyframes of the map that is in the folder already and is gone on with.
  MapWriter(std::filesystem::path capture, std::size_t on_disk);

  /// Throws config::InputError on the first error of the disk, and if the map could not be read
  /// again; pictures that no map.json came to name are removed then, as they take room.
  void write(const tracking::MapView& map, const geometry::Camera& camera,
             const DurableFiles& files);

 private:
  void write_pictures(const tracking::MapView& map, const DurableFiles& files,
                      std::vector<tracking::KeyframeId>* written);
  void forget(const std::vector<tracking::KeyframeId>& pictures, const DurableFiles& files);

  std::filesystem::path capture_;
  std::set<tracking::KeyframeId> pictures_;  ///< on disk
};

/// Reads the map that a capture folder keeps, to the bit as it was written; pyramids of at most
/// `levels` levels are built anew. Throws config::InputError that names the file and what was
/// expected if the map is missing or damaged, or was made with another camera.
tracking::MapView read_map(const std::filesystem::path& capture, const geometry::Camera& camera,
                           int levels);

}  // namespace lumibox::lightfield
