#pragma once

#include <filesystem>
#include <string>

#include "hal/image.h"
#include "support/temp_dir.h"

namespace lumibox::testing {

/// A small recording in the layout of the TUM benchmark, good until a test spoils it: `frames`
/// pictures of 32x24 pixels at 10 frames per second from 5 s on, with ground truth and subject.
class Recording {
 public:
  static constexpr int kWidth = 32;
  static constexpr int kHeight = 24;

  enum class Medium { Images, Video };

  explicit Recording(Medium medium = Medium::Images, int frames = 5);

  const std::filesystem::path& folder() const { return dir_.path(); }
  const TempDir& dir() const { return dir_; }

  /// Picture number `frame`: grey ramps whose mean tells one frame from the next, also after lossy
  /// compression.
  static hal::Image picture(int frame);

  /// Name of a picture within the folder: "rgb/000003.png".
  static std::string name(int frame);

 private:
  TempDir dir_;
};

/// Writes frames 0 … frames-1 of Recording::picture() as a video.
void write_video(const std::filesystem::path& file, int frames);

}  // namespace lumibox::testing
