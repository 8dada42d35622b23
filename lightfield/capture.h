#pragma once

#include <filesystem>
#include <vector>

#include "lightfield/light_field.h"

namespace lumibox::lightfield {

/// A capture folder read into memory: the light field and the points of its map.
struct Capture {
  LightField light_field;
  std::vector<Eigen::Vector3d> points;  ///< in world; may be empty
};

/// Reads a capture folder (transforms.json, images, points.ply). Throws config::InputError that
/// names the file and what was expected.
Capture load_capture(const std::filesystem::path& folder);

/// Reads SOURCE, which is a nerfstudio or instant-ngp transforms.json, or a folder with a COLMAP
/// model (text or binary; images beside it or in images/). Where the source names no subject,
/// S is the point nearest to all optical axes. Errors as load_capture.
Capture import_capture(const std::filesystem::path& source);

enum class ExportFormat { Nerfstudio, Colmap };

/// Writes a capture in another layout into `folder`, which must be empty or absent.
void export_capture(const Capture& capture, ExportFormat format,
                    const std::filesystem::path& folder);

}  // namespace lumibox::lightfield
