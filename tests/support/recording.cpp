#include "support/recording.h"

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "hal/image_io.h"

namespace lumibox::testing {
namespace {

constexpr double kFps = 10.0;

}  // namespace

Recording::Recording(Medium medium, int frames) {
  std::string list = "# timestamp filename\n";
  std::string truth = "# timestamp tx ty tz qx qy qz qw\n";
  for (int i = 0; i < frames; ++i) {
    const std::string time = std::to_string(5.0 + i / kFps);
    list += time + " " + name(i) + "\n";
    truth += time + " " + std::to_string(i) + " 0 0.5 0 0 0 1\n";
  }
  dir_.write("rgb.txt", list);
  dir_.write("groundtruth.txt", truth);
  dir_.write("subject.txt", "1 2 3 0.25\n");
  dir_.write("calib.txt", "30 31 15.5 11.5 0.1 0.01 0.001 0.002 32 24 10 -0.003 0.02\n");
  if (medium == Medium::Video) {
    write_video(dir_ / "rgb.mp4", frames);
    return;
  }
  std::filesystem::create_directory(dir_ / "rgb");
  for (int i = 0; i < frames; ++i) {
    hal::write_png(dir_ / name(i), picture(i));
  }
}

hal::Image Recording::picture(int frame) {
  hal::Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int level = 40 + 16 * frame + x;
      image.at(x, y)[0] = static_cast<std::uint8_t>(level + 8);
      image.at(x, y)[1] = static_cast<std::uint8_t>(level);
      image.at(x, y)[2] = static_cast<std::uint8_t>(level - 8);
    }
  }
  return image;
}

std::string Recording::name(int frame) {
  const std::string digits = std::to_string(frame);
  return "rgb/" + std::string(6 - digits.size(), '0') + digits + ".png";
}

void write_video(const std::filesystem::path& file, int frames) {
  cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                         kFps, {Recording::kWidth, Recording::kHeight});
  if (!writer.isOpened()) {
    throw std::runtime_error("no encoder for the test's video");
  }
  for (int i = 0; i < frames; ++i) {
    const hal::Image image = Recording::picture(i);
    cv::Mat bgr(image.height(), image.width(), CV_8UC3);
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const std::uint8_t* rgb = image.at(x, y);
        bgr.at<cv::Vec3b>(y, x) = cv::Vec3b(rgb[2], rgb[1], rgb[0]);
      }
    }
    writer.write(bgr);
  }
}

}  // namespace lumibox::testing
