#pragma once

#include <Eigen/Core>

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

/// The smallest box with all pixels where a mask is not 0; both ends belong to it.
struct Box {
  int left = 0, top = 0, right = -1, bottom = -1;

  bool empty() const { return right < left || bottom < top; }
  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
};
Box box_of(const hal::Image& mask);

/// By how many pixels what `b` shows lies beside where `a` shows it: the shift, of at most `reach`
/// each way, after which the two differ least (sum of squares over the luma where `mask` is not 0),
/// to a fraction of a pixel by parabolas. Zero if the sizes differ or no pixel counts.
Eigen::Vector2d shift_between(const hal::Image& a, const hal::Image& b, const hal::Image& mask,
                              int reach);

/// Most that the colours of two pictures differ over an area, grey levels: the root mean square of
/// the three channels' differences of mean in a cell, of which a tenth of the cells across the
/// masked pixels have more. Edges that lie a little beside each other hardly count: a cell is a
/// tenth of what `mask` shows wide. NaN if the sizes differ or no cell counts.
double patch_difference(const hal::Image& a, const hal::Image& b, const hal::Image& mask);

/// 255 where the view looks at the subject's sphere, 0 elsewhere; one channel, size of view.camera.
hal::Image subject_mask(const View& view, const lightfield::Sphere& sphere);

}  // namespace lumibox::render
