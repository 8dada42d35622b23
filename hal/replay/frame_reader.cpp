#include "hal/replay/frame_reader.h"

#include <string>

#include "config/error.h"
#include "hal/image_io.h"
#include "hal/replay/video_reader.h"

namespace lumibox::hal {
namespace {

void check_size(const Image& image, const config::CameraProfile& profile,
                const std::filesystem::path& file) {
  if (image.width() != profile.width || image.height() != profile.height) {
    throw config::InputError(file, "picture of " + std::to_string(image.width()) + "x" +
                                       std::to_string(image.height()) + " pixels; expected " +
                                       std::to_string(profile.width) + "x" +
                                       std::to_string(profile.height));
  }
}

class ImageFiles : public FrameReader {
 public:
  explicit ImageFiles(const Sequence& sequence) : sequence_(sequence) {}

  Image read(std::size_t entry) override {
    const std::filesystem::path& file = sequence_.entries.at(entry).image;
    Image image = read_image(file);
    check_size(image, sequence_.profile, file);
    return image;
  }

 private:
  const Sequence& sequence_;
};

class VideoFrames : public FrameReader {
 public:
  explicit VideoFrames(const Sequence& sequence) : sequence_(sequence), reader_(*sequence.video) {}

  Image read(std::size_t entry) override {
    reader_.skip(static_cast<std::int64_t>(entry - next_));
    next_ = entry + 1;
    std::optional<Image> image = reader_.next();
    if (!image) {
      throw config::InputError(*sequence_.video, "the video ends before frame " +
                                                     std::to_string(entry) + " of " +
                                                     std::to_string(sequence_.entries.size()));
    }
    check_size(*image, sequence_.profile, *sequence_.video);
    return *std::move(image);
  }

 private:
  const Sequence& sequence_;
  VideoReader reader_;
  std::size_t next_ = 0;  ///< frame that the reader stands before
};

}  // namespace

std::unique_ptr<FrameReader> make_frame_reader(const Sequence& sequence) {
  if (sequence.video) {
    return std::make_unique<VideoFrames>(sequence);
  }
  return std::make_unique<ImageFiles>(sequence);
}

}  // namespace lumibox::hal
