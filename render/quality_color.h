#pragma once

#include "render/overlay.h"

namespace lumibox::render {

/// Colour of a perspective whose picture is so like the others' (Judgement::psnr, dB): orange up to
/// 18 dB, white at 26, blue from 34 on, which the colour-blind tell apart too; grey for none.
Color color_of_quality(std::optional<double> psnr);

}  // namespace lumibox::render
