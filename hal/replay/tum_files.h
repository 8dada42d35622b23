#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/replay/sequence.h"

/// The text files of a recording, besides those that sequence.h offers to everyone. All throw
/// config::InputError with file and line.
namespace lumibox::hal {

/// A line of rgb.txt.
struct ImageLine {
  int line = 0;  ///< from 1
  std::int64_t timestamp_ns = 0;
  std::string name;  ///< the rest of the line; may be empty, which only a video allows
};

/// At least one line, times strictly increasing.
std::vector<ImageLine> read_image_list(const std::filesystem::path& file);

/// As read_tum_trajectory(), times strictly increasing.
std::vector<StampedPose> read_ground_truth(const std::filesystem::path& file);

Sequence::Subject read_subject(const std::filesystem::path& file);

}  // namespace lumibox::hal
