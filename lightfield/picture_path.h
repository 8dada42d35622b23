#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "hal/image.h"

namespace lumibox::lightfield {

/// True if `path` names something below the folder it is relative to: not absolute, no way out by
/// "..". A data set from elsewhere must not reach for files outside it.
bool stays_inside(const std::string& path);

/// Throws config::InputError that names `file` and lists the pictures it speaks of that do not
/// exist in `folder`.
void require_pictures(const std::filesystem::path& file, const std::filesystem::path& folder,
                      const std::vector<std::string>& pictures);

/// Reads a picture as three channels. Throws config::InputError if it is damaged or its size is not
/// the camera's.
std::shared_ptr<const hal::Image> read_picture(const std::filesystem::path& path,
                                               const geometry::Camera& camera);

}  // namespace lumibox::lightfield
