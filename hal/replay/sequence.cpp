#include "hal/replay/sequence.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "config/error.h"
#include "config/input_file.h"
#include "config/log.h"
#include "hal/image_io.h"
#include "hal/replay/tum_files.h"
#include "hal/replay/video_reader.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;
using config::CameraProfile;
using config::InputError;

constexpr double kVideoFieldOfViewDeg = 60.0;
constexpr double kImagesFieldOfViewDeg = 45.0;
constexpr double kImagesFps = 30.0;

/// A pinhole camera with square pixels and the image's centre as its principal point.
CameraProfile assume_profile(int width, int height, double fps, double field_of_view_deg) {
  CameraProfile profile;
  profile.width = width;
  profile.height = height;
  profile.fps = fps;
  profile.fx = width / 2.0 / std::tan(field_of_view_deg / 2.0 * std::numbers::pi / 180.0);
  profile.fy = profile.fx;
  profile.cx = (width - 1) / 2.0;
  profile.cy = (height - 1) / 2.0;
  return profile;
}

void say_assumed(Sequence& sequence, double field_of_view_deg) {
  sequence.profile_assumed = true;
  config::log_warning(
      fmt::format("{}: no calibration; a horizontal field of view of {:.0f} degrees is assumed "
                  "(focal length {:.1f} pixels at {}x{}, {:.3g} frames per second)",
                  sequence.path.string(), field_of_view_deg, sequence.profile.fx,
                  sequence.profile.width, sequence.profile.height, sequence.profile.fps));
}

void check_size(int width, int height, const CameraProfile& profile, const fs::path& picture,
                const fs::path& calibration) {
  if (width != profile.width || height != profile.height) {
    throw InputError(picture, "picture of " + std::to_string(width) + "x" + std::to_string(height) +
                                  " pixels; " + calibration.string() + " says " +
                                  std::to_string(profile.width) + "x" +
                                  std::to_string(profile.height));
  }
}

Image first_frame(const fs::path& video) {
  std::optional<Image> frame = VideoReader(video).next();
  if (!frame) {
    throw InputError(video, "a video without frames");
  }
  return *std::move(frame);
}

/// A file of the folder, if it is there.
std::optional<fs::path> optional_file(const fs::path& folder, const char* name) {
  const fs::path file = folder / name;
  std::error_code ignored;
  return fs::exists(file, ignored) ? std::optional(file) : std::nullopt;
}

/// The calibration to use: the one given on the command line, else the folder's own.
std::optional<fs::path> calibration_of(const fs::path& folder,
                                       const std::optional<fs::path>& given) {
  return given ? given : optional_file(folder, "calib.txt");
}

bool lies_inside(const fs::path& target, const fs::path& root) {
  const fs::path relative = target.lexically_relative(root);
  return !relative.empty() && *relative.begin() != "..";
}

/// " by the link FILE", if one leads out of the folder on the way to the name.
std::string by_link(const fs::path& folder, const fs::path& root, const fs::path& name) {
  std::error_code ignored;
  fs::path way = folder;
  for (const fs::path& part : name) {
    const bool was_inside = lies_inside(fs::weakly_canonical(way, ignored), root);
    way /= part;
    if (was_inside && fs::is_symlink(way, ignored) &&
        !lies_inside(fs::weakly_canonical(way, ignored), root)) {
      return " by the link " + way.string();
    }
  }
  return {};
}

/// folder/name, which must be a file that lies inside the folder when all links are followed:
/// a recording from somebody else must not reach into the rest of the disk.
fs::path resolve_inside(const fs::path& folder, const ImageLine& line, const fs::path& list) {
  if (line.name.empty()) {
    throw InputError(list, line.line, "no file name; expected `timestamp file`");
  }
  const fs::path file = folder / line.name;
  std::error_code failure;
  const fs::path root = fs::canonical(folder, failure);
  const fs::path target = failure ? fs::path() : fs::weakly_canonical(file, failure);
  if (failure) {
    throw InputError(list, line.line, "image " + file.string() + ": " + failure.message());
  }
  if (!lies_inside(target, root)) {
    throw InputError(list, line.line,
                     "image " + line.name + " leaves the folder " + folder.string() +
                         by_link(folder, root, line.name));
  }
  if (const auto fault = config::fault_of_file(target)) {
    throw InputError(list, line.line, "image " + file.string() + ": " + *fault);
  }
  return file;
}

void take_images(Sequence& sequence, const std::vector<ImageLine>& lines, const fs::path& list) {
  for (const ImageLine& line : lines) {
    sequence.entries.push_back({line.timestamp_ns, resolve_inside(sequence.path, line, list)});
  }
}

void take_video(Sequence& sequence, const std::vector<ImageLine>& lines, const fs::path& list) {
  const std::int64_t frames = read_video_info(*sequence.video).frames;
  if (frames < static_cast<std::int64_t>(lines.size())) {
    throw InputError(*sequence.video, "video of " + std::to_string(frames) + " frames; " +
                                          list.string() + " has " + std::to_string(lines.size()) +
                                          " lines");
  }
  for (const ImageLine& line : lines) {
    sequence.entries.push_back({line.timestamp_ns, {}});
  }
}

void check_first_picture(const Sequence& sequence, const fs::path& calibration) {
  if (sequence.video) {
    const Image frame = first_frame(*sequence.video);
    check_size(frame.width(), frame.height(), sequence.profile, *sequence.video, calibration);
  } else {
    const fs::path& file = sequence.entries.front().image;
    const ImageInfo info = read_image_info(file);
    check_size(info.width, info.height, sequence.profile, file, calibration);
  }
}

Sequence open_tum_folder(const fs::path& folder, const std::optional<fs::path>& given) {
  Sequence sequence;
  sequence.path = folder;
  const std::optional<fs::path> calibration = calibration_of(folder, given);
  if (!calibration) {
    throw InputError(folder / "calib.txt",
                     "no such file; expected the camera's calibration there "
                     "or with --calib");
  }
  sequence.profile = read_calibration(*calibration);

  const fs::path list = folder / "rgb.txt";
  const std::vector<ImageLine> lines = read_image_list(list);
  sequence.video = optional_file(folder, "rgb.mp4");
  if (sequence.video) {
    take_video(sequence, lines, list);
  } else {
    take_images(sequence, lines, list);
  }
  check_first_picture(sequence, *calibration);

  if (const auto file = optional_file(folder, "groundtruth.txt")) {
    sequence.ground_truth = read_ground_truth(*file);
    if (sequence.ground_truth.empty()) {
      config::log_warning(file->string() + ": no poses; the recording counts as one without truth");
    }
  }
  if (const auto file = optional_file(folder, "subject.txt")) {
    sequence.subject = read_subject(*file);
  }
  return sequence;
}

/// The pictures that lie in a folder, by name.
std::vector<fs::path> list_images(const fs::path& folder) {
  std::vector<fs::path> images;
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
    std::string extension = entry.path().extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    constexpr std::string_view kExtensions[] = {".jpg", ".jpeg", ".png", ".pgm", ".ppm"};
    if (std::ranges::find(kExtensions, extension) != std::end(kExtensions) &&
        entry.is_regular_file(failure)) {
      images.push_back(entry.path());
    }
  }
  std::ranges::sort(images);
  return images;
}

Sequence open_image_folder(const fs::path& folder, const std::optional<fs::path>& given) {
  Sequence sequence;
  sequence.path = folder;
  const std::vector<fs::path> images = list_images(folder);
  if (images.empty()) {
    throw InputError(folder, "holds neither rgb.txt nor images; expected a sequence");
  }
  const ImageInfo first = read_image_info(images.front());
  const std::optional<fs::path> calibration = calibration_of(folder, given);
  if (calibration) {
    sequence.profile = read_calibration(*calibration);
    check_size(first.width, first.height, sequence.profile, images.front(), *calibration);
  } else {
    sequence.profile = assume_profile(first.width, first.height, kImagesFps, kImagesFieldOfViewDeg);
    say_assumed(sequence, kImagesFieldOfViewDeg);
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    const double seconds = static_cast<double>(i) / sequence.profile.fps;
    sequence.entries.push_back({std::llround(seconds * 1e9), images[i]});
  }
  return sequence;
}

Sequence open_bare_video(const fs::path& video, const std::optional<fs::path>& calibration) {
  Sequence sequence;
  sequence.path = video;
  sequence.video = video;
  const Image first = first_frame(video);
  const VideoInfo info = read_video_info(video);
  if (calibration) {
    sequence.profile = read_calibration(*calibration);
    check_size(first.width(), first.height(), sequence.profile, video, *calibration);
  } else {
    sequence.profile =
        assume_profile(first.width(), first.height(), info.fps, kVideoFieldOfViewDeg);
    say_assumed(sequence, kVideoFieldOfViewDeg);
  }
  for (std::int64_t i = 0; i < info.frames; ++i) {
    const double seconds = static_cast<double>(i) / info.fps;
    sequence.entries.push_back({std::llround(seconds * 1e9), {}});
  }
  return sequence;
}

}  // namespace

Sequence open_sequence(const fs::path& path, const std::optional<fs::path>& calibration) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    throw InputError(path, "no such file or folder; expected a sequence");
  }
  if (!fs::is_directory(path, ignored)) {
    return open_bare_video(path, calibration);
  }
  if (optional_file(path, "rgb.txt")) {
    return open_tum_folder(path, calibration);
  }
  return open_image_folder(path, calibration);
}

}  // namespace lumibox::hal
