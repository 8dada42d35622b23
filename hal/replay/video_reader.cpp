#include "hal/replay/video_reader.h"

#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "config/error.h"
#include "config/input_file.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;

/// What is wrong with a video is said once, by us: ffmpeg and OpenCV have their own words for it,
/// on stderr. Their log can still be had by setting the variable.
void silence_libraries() {
  static const int silenced = [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET; read at the first video
  }();
  static_cast<void>(silenced);
}

cv::VideoCapture open(const fs::path& file, const std::vector<int>& parameters) {
  silence_libraries();
  if (const auto fault = config::fault_of_file(file)) {
    throw config::InputError(file, *fault + "; expected a video");
  }
  try {
    cv::VideoCapture capture(file.string(), cv::CAP_FFMPEG, parameters);
    if (capture.isOpened()) {
      return capture;
    }
  } catch (const cv::Exception&) {
    // Reported below, in words for a person.
  }
  throw config::InputError(file,
                           "cannot be read as a video; the file is damaged or of a kind "
                           "that this system has no decoder for");
}

}  // namespace

class VideoReader::Impl {
 public:
  explicit Impl(const fs::path& file) : capture_(open(file, {})) {}

  std::optional<Image> next() {
    cv::Mat bgr;
    if (!capture_.read(bgr) || bgr.type() != CV_8UC3) {
      return std::nullopt;
    }
    Image image(bgr.cols, bgr.rows, 3);
    cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data());
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    return image;
  }

  void skip(std::int64_t frames) {
    while (frames > 0 && capture_.grab()) {
      --frames;
    }
  }

 private:
  cv::VideoCapture capture_;
};

VideoReader::VideoReader(const fs::path& file) : impl_(std::make_unique<Impl>(file)) {}
VideoReader::~VideoReader() = default;
std::optional<Image> VideoReader::next() {
  return impl_->next();
}
void VideoReader::skip(std::int64_t frames) {
  impl_->skip(frames);
}

VideoInfo read_video_info(const fs::path& file) {
  // Format -1 hands out the encoded packets, so that counting them is quick.
  cv::VideoCapture packets = open(file, {cv::CAP_PROP_FORMAT, -1});
  VideoInfo info;
  info.fps = packets.get(cv::CAP_PROP_FPS);
  while (packets.grab()) {
    ++info.frames;
  }
  if (info.frames == 0 || !(info.fps > 0.0)) {
    throw config::InputError(file, "a video without frames or without a frame rate");
  }
  return info;
}

}  // namespace lumibox::hal
