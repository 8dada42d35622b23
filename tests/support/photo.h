#pragma once

#include <filesystem>
#include <memory>
#include <utility>

#include "hal/image_io.h"
#include "lightfield/photo.h"

namespace lumibox::testing {

/// A photo that is in memory only.
inline std::shared_ptr<lightfield::Photo> photo_of(hal::Image pixels) {
  return std::make_shared<lightfield::Photo>(std::make_shared<const hal::Image>(std::move(pixels)));
}

/// Puts its pixels into a file, without loss, and has it let go of them.
inline void store_as_png(lightfield::Photo& photo, const std::filesystem::path& file) {
  hal::write_png(file, *photo.rgb());
  photo.stored_in(file);
}

}  // namespace lumibox::testing
