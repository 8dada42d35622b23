#pragma once

#include <opencv2/core/mat.hpp>

#include "hal/image.h"

namespace lumibox::tracking {

/// A one-channel picture as OpenCV reads it, without a copy; the picture must outlive the view.
/// cv::Mat knows no constness: nothing may be written through it.
inline cv::Mat opencv_view(const hal::Image& image) {
  return {image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.data())};
}

}  // namespace lumibox::tracking
