#pragma once

#include <filesystem>
#include <vector>

#include "lightfield/durable_files.h"
#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// A COLMAP reconstruction; pictures not read yet, perspectives without `color`, in order of name.
struct ColmapModel {
  std::vector<Perspective> perspectives;
  std::vector<Eigen::Vector3d> points;
  std::filesystem::path pictures_folder;  ///< perspectives' files are relative to it
};

/// Reads a model, text or binary, from the folder itself, its sparse/0 or its sparse. Throws
/// config::InputError.
ColmapModel read_colmap(const std::filesystem::path& folder);

/// Writes a text model (cameras.txt, images.txt, points3D.txt) beside the images/ that
/// the perspectives' files name. Throws config::InputError.
void write_colmap(const std::vector<Perspective>& perspectives,
                  const std::vector<Eigen::Vector3d>& points, const std::filesystem::path& folder,
                  const DurableFiles& files);

}  // namespace lumibox::lightfield
