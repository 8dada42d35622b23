#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/camera_profile.h"
#include "config/config.h"

namespace lumibox::config {

struct Sources {
  std::filesystem::path system_file = "/etc/lumibox/lumibox.toml";  ///< read if it exists
  std::optional<std::filesystem::path> file = {};                   ///< --config; must exist
  std::vector<std::string> assignments = {};                        ///< --set section.key=value
};

/// Defaults, overridden by the system file, then `file`, then the assignments in order. An unknown
/// key, a wrong type or a value out of range throws InputError naming file and line (or the
/// assignment), the key, and what is allowed.
Config load(const Sources& sources);

/// A camera profile file (TOML: model, width, height, fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, fps,
/// readout_s). Errors as load().
CameraProfile load_camera_profile(const std::filesystem::path& file);

/// The content of such a file; reading it gives the same profile to the last bit.
std::string profile_text(const CameraProfile& profile);

}  // namespace lumibox::config
