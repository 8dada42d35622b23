#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/image.h"
#include "hal/live/modes.h"

namespace lumibox::testing {

/// The picture that a camera in memory takes as its `number`-th since its stream began: colours
/// that change slowly, so that coarse chroma loses little.
hal::Image picture_of(int number, int width, int height);

/// The same as a driver hands it over, plane after plane. `padding`: bytes at the end of each row,
/// of an even number, but for JPEG.
std::vector<std::uint8_t> encode(const hal::Image& picture, hal::live::PixelFormat format,
                                 bool limited_range = false, std::size_t padding = 0);

/// Until when a camera gives no picture.
enum class Silence { None, UntilBegunAnew, UntilOpenedAnew, ForGood };

/// Of a camera whose stream was begun, and which was opened, so many times.
bool is_silent(Silence silence, int streams, int opened);

}  // namespace lumibox::testing
