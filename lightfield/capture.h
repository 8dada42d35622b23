#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "lightfield/light_field.h"

namespace lumibox::lightfield {

/// A capture in memory: the light field and the points of its map.
struct Capture {
  LightField light_field;
  std::vector<Eigen::Vector3d> points;  ///< in world; may be empty
  std::optional<double> threshold;      ///< of the gate it was last recorded with, radians
  /// Where the pictures' original files lie: Perspective::file is relative to it. Empty if there
  /// are none.
  std::filesystem::path folder;
};

/// Reads a capture folder (transforms.json, images, points.ply; docs/capture-format.md). Throws
/// config::InputError that names the file and what was expected.
Capture load_capture(const std::filesystem::path& folder);

/// Points in world of what perspectives show, as find_scene_points.
using PointFinder = std::function<std::vector<Eigen::Vector3d>(const std::vector<Perspective>&)>;

/// Reads SOURCE, which is a nerfstudio or instant-ngp transforms.json (or its folder), or a folder
/// with a COLMAP model (text or binary; the folder itself, its sparse/0 or its sparse; images
/// beside it or in images/). Where the source names no subject, S is the point nearest to all
/// optical axes. Errors as load_capture. Where it has no points, `find_points` is asked for some.
Capture import_capture(const std::filesystem::path& source, const PointFinder& find_points = {});

/// Writes a capture folder that load_capture reads. Pictures whose original file exists are copied
/// byte for byte, others become JPEGs of `jpeg_quality`. transforms.json comes last: a folder that
/// has one is complete. Throws config::InputError if `folder` exists and is not empty, or on the
/// first error of the disk.
void save_capture(const Capture& capture, const std::filesystem::path& folder, int jpeg_quality);

enum class ExportFormat {
  Nerfstudio,  ///< transforms.json without the box's own keys, images/, points.ply
  Colmap,      ///< text model: cameras.txt, images.txt, points3D.txt, images/
};

/// Writes a capture in another layout into `folder`, which must be empty or absent. Pictures and
/// errors as save_capture.
void export_capture(const Capture& capture, ExportFormat format,
                    const std::filesystem::path& folder, int jpeg_quality = 95);

}  // namespace lumibox::lightfield
