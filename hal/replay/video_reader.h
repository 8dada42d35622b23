#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "hal/image.h"

namespace lumibox::hal {

/// The frames of a video file, one after the other.
class VideoReader {
 public:
  /// Throws config::InputError if the file is no video that can be read.
  explicit VideoReader(const std::filesystem::path& file);
  ~VideoReader();

  /// The next frame, three channels; none after the last one.
  std::optional<Image> next();

  /// Passes over frames without converting them; stops at the end of the video.
  void skip(std::int64_t frames);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a video's container says of it; the pictures are not decoded.
struct VideoInfo {
  std::int64_t frames = 0;
  double fps = 0.0;
};
VideoInfo read_video_info(const std::filesystem::path& file);

}  // namespace lumibox::hal
