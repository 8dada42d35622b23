#pragma once

#include "hal/image.h"
#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

/// PSNR of equal pictures, and the most that psnr() returns, dB.
inline constexpr double kMaxPsnr = 99.0;

/// Peak signal to noise ratio in dB of two pictures of the same size and channels, over all
/// channels of the pixels where `mask` (one channel, same size; null for all) is not 0. NaN if the
/// sizes differ or no pixel counts.
double psnr(const hal::Image& a, const hal::Image& b, const hal::Image* mask = nullptr);

/// Structural similarity (Wang et al., IEEE Trans. Image Processing 13(4), 2004): luma, Gaussian
/// window of 11x11 with sigma 1.5, mean over the pixels whose window lies within the picture and
/// where `mask` is not 0. NaN if the sizes differ or no pixel counts.
double ssim(const hal::Image& a, const hal::Image& b, const hal::Image* mask = nullptr);

/// 255 where the view looks at the subject's sphere, 0 elsewhere; one channel, size of view.camera.
hal::Image subject_mask(const View& view, const lightfield::Sphere& sphere);

}  // namespace lumibox::render
