#pragma once

#include <string>
#include <vector>

#include "config/camera_profile.h"
#include "config/config.h"
#include "config/key.h"

namespace lumibox::config {

/// All keys of lumibox.toml, in its order, bound to the members of `config`.
std::vector<Key> schema(Config& config);

/// A camera profile as its file has it, where the model is a word.
struct ProfileFile {
  CameraProfile profile;
  std::string model = "opencv";
};

/// All keys of a camera profile, bound to the members of `file`.
std::vector<Key> schema(ProfileFile& file);

}  // namespace lumibox::config
