#pragma once

#include <filesystem>
#include <vector>

#include "lightfield/capture.h"
#include "lightfield/durable_files.h"

namespace lumibox::lightfield {

/// Puts the capture's pictures into `folder`/images: a copy of the original's bytes where there is
/// one, else a JPEG. Returns the perspectives with their new files. Throws config::InputError.
std::vector<Perspective> copy_pictures(const Capture& capture, const std::filesystem::path& folder,
                                       int jpeg_quality, const DurableFiles& files);

}  // namespace lumibox::lightfield
