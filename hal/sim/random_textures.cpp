#include "hal/sim/random_textures.h"

#include <bit>
#include <cmath>

namespace lumibox::hal::sim {
namespace {

/// Hue in turns; saturation and value in [0, 1].
Color from_hsv(double hue, double saturation, double value) {
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + 6.0 * (hue - std::floor(hue)), 6.0);
    const double fall = std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
    return static_cast<float>(value - value * saturation * fall);
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

/// The power of two next to a number of texels.
int texels(double side_m, double texel_m) {
  const double wanted = std::clamp(side_m / texel_m, 64.0, 2048.0);
  return static_cast<int>(std::bit_floor(static_cast<unsigned>(1.4 * wanted)));
}

}  // namespace

std::vector<Color> random_palette(int colors, double contrast, Random& random) {
  const double hue = random.uniform();
  const double spread = random.uniform(0.02, 0.25);
  const double saturation = random.uniform(0.05, 0.6);
  const double middle = random.uniform(0.45, 0.65);
  std::vector<Color> palette;
  for (int i = 0; i < colors; ++i) {
    // Dark and light in turn, so that neighbours in the palette differ.
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double value =
        std::clamp(middle + side * contrast * random.uniform(0.2, 0.45), 0.08, 0.95);
    const bool accent = i > 1 && contrast > 0.3 && random.uniform() < 0.3;
    const double own_hue = hue + (accent ? 0.5 : 0.0) + spread * random.uniform(-1.0, 1.0);
    palette.push_back(from_hsv(own_hue, saturation * random.uniform(0.6, 1.2), value));
  }
  return palette;
}

TextureSpec random_texture(const std::string& name, std::initializer_list<Pattern> patterns,
                           double width, double height, double texel_m, Random& random) {
  TextureSpec texture;
  texture.name = name;
  texture.pattern = patterns.begin()[random.below(static_cast<int>(patterns.size()))];
  // Tiles that repeat are rare in the world: mostly one covers the surface.
  const double cover =
      random.uniform() < 0.25 ? random.uniform(0.4, 0.8) : random.uniform(1.0, 1.3);
  texture.tile_m = cover * Eigen::Vector2d(width, height);
  texture.texels_x = texels(texture.tile_m.x(), texel_m);
  texture.texels_y = texels(texture.tile_m.y(), texel_m);
  texture.cell_m = texture.tile_m.minCoeff() * random.uniform(0.08, 0.35);
  texture.cell_m = std::max(texture.cell_m, texture.tile_m.maxCoeff() / 100.0);
  texture.grain = 0.06 * std::pow(7.0, random.uniform());
  // Neighbouring boards are of one wood.
  const double contrast = texture.pattern == Pattern::Wood ? 0.25 : 1.0;
  texture.palette =
      random_palette(3 + random.below(4), contrast * random.uniform(0.3, 1.0), random);
  texture.seed = random.bits() >> 40;
  return texture;
}

}  // namespace lumibox::hal::sim
