#pragma once

#include <vector>

#include "config/camera_profile.h"
#include "config/config.h"
#include "config/key.h"

namespace lumibox::config {

/// All keys of lumibox.toml, in its order, bound to the members of `config`.
std::vector<Key> schema(Config& config);

/// All keys of a camera profile, bound to the members of `profile`.
std::vector<Key> schema(CameraProfile& profile);

}  // namespace lumibox::config
