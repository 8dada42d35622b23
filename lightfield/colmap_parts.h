#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/camera_profile.h"
#include "geometry/pose.h"

namespace lumibox::lightfield {

/// One line of images.txt.
struct ColmapImage {
  std::string name;
  std::int64_t camera_id = 0;
  geometry::Pose camera_from_world;
};

/// A model's files as they are; nothing resolved yet.
struct ColmapParts {
  std::map<std::int64_t, config::CameraProfile> cameras;
  std::vector<ColmapImage> images;
  std::vector<Eigen::Vector3d> points;
};

/// Reads the three files of a model in `folder`; points may be absent. Throw config::InputError.
ColmapParts read_colmap_text(const std::filesystem::path& folder);
ColmapParts read_colmap_binary(const std::filesystem::path& folder);

/// A camera model that we can represent: its parameters' order is COLMAP's.
struct ColmapLens {
  int id = 0;  ///< in binary files
  std::string_view name;
  std::size_t parameters = 0;
};

/// By name or id; none if there is no such model or it is not a special case of ours.
const ColmapLens* find_lens(std::string_view name);
const ColmapLens* find_lens(int id);

/// What an error message says instead.
inline constexpr const char* kKnownLenses =
    "expected SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV or "
    "OPENCV_FISHEYE";

/// Name of a model that find_lens() does not know, for an error message.
std::string foreign_lens_name(int id);

/// Our camera of a COLMAP one; sets `flaw` to what is wrong with it, or to nothing.
config::CameraProfile to_profile(const ColmapLens& lens, std::int64_t width, std::int64_t height,
                                 std::span<const double> parameters, std::string* flaw);

/// Pose of an image; sets `flaw` likewise, as the object of "has".
geometry::Pose to_pose(std::span<const double, 7> quaternion_wxyz_and_translation,
                       std::string* flaw);

}  // namespace lumibox::lightfield
