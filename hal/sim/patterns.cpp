#include "hal/sim/patterns.h"

#include <numbers>

#include "hal/sim/noise.h"
#include "hal/sim/pattern_tools.h"

namespace lumibox::hal::sim {
namespace {

using Eigen::Vector2d;

void text_line(Canvas& canvas, Vector2d corner, double height, double width, const Color& ink,
               Random& random) {
  const double end = corner.x() + width;
  while (corner.x() + height < end) {
    if (random.uniform() < 0.82) glyph(canvas, corner, height, ink, random);
    corner.x() += 0.85 * height;
  }
}

/// Shapes of all sizes over each other, the small ones last; some lines of writing.
Canvas poster(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, spec.palette.front());
  const Vector2d tile = spec.tile_m;
  const auto somewhere = [&] {
    return Vector2d(random.uniform(0.0, tile.x()), random.uniform(0.0, tile.y()));
  };
  for (double size = spec.cell_m; size > spec.cell_m / 20.0; size *= 0.6) {
    const int shapes = std::clamp(count(0.35 * tile.prod(), size * size), 3, 400);
    for (int i = 0; i < shapes; ++i) {
      const Color color = shade(pick(spec.palette, random), random.uniform(0.7, 1.15));
      const Vector2d at = somewhere();
      const double extent = size * random.uniform(0.6, 1.2);
      switch (random.below(5)) {
        case 0:
          canvas.disc(at, 0.45 * extent, color);
          break;
        case 1:
          canvas.ring(at, 0.4 * extent, 0.15 * extent, color);
          break;
        case 2:
          glyph(canvas, at, extent, color, random);
          break;
        default:
          canvas.rectangle(at, {extent, extent * random.uniform(0.2, 1.0)},
                           random.uniform(0.0, std::numbers::pi), color);
      }
    }
  }
  const int paragraphs = count(tile.prod(), 4.0 * spec.cell_m * spec.cell_m);
  for (int i = 0; i < paragraphs; ++i) {
    const Vector2d corner = somewhere();
    const double height = spec.cell_m * random.uniform(0.06, 0.16);
    const Color ink = shade(pick(spec.palette, random), 0.45);
    for (int line = 0; line < 3; ++line) {
      text_line(canvas, corner + Vector2d(0.0, 1.6 * height * line), height, spec.cell_m, ink,
                random);
    }
  }
  return canvas;
}

/// Planks along x with grain, knots and joints.
Canvas wood(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, spec.palette.front());
  const int planks = count(spec.tile_m.y(), spec.cell_m);
  const double plank_m = spec.tile_m.y() / planks;
  // Grain: noise forty times longer than wide.
  const int across = planks * 6;
  const int along = std::max(1, across / 40);
  const auto grain =
      fractal_noise_tile(canvas.width(), canvas.height(), along, across, 6, 0.75f, random.bits());
  std::vector<Color> tones;
  for (int i = 0; i < planks; ++i) {
    tones.push_back(shade(pick(spec.palette, random), random.uniform(0.8, 1.1)));
  }
  std::size_t texel = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    const auto plank = static_cast<std::size_t>(canvas.center_of(0, y).y() / plank_m) %
                       static_cast<std::size_t>(planks);
    for (int x = 0; x < canvas.width(); ++x, ++texel) {
      canvas.at(x, y) = shade(tones[plank], 1.0 + 1.3 * (static_cast<double>(grain[texel]) - 0.5));
    }
  }
  for (int i = 0; i < planks; ++i) {
    const double top = i * plank_m;
    const Color dark = shade(tones[static_cast<std::size_t>(i)], 0.35);
    canvas.stroke({0.0, top}, {spec.tile_m.x(), top}, 0.02 * plank_m, dark);
    const double joint = random.uniform(0.0, spec.tile_m.x());
    canvas.stroke({joint, top}, {joint, top + plank_m}, 0.02 * plank_m, dark);
    for (const double side : {-1.0, 1.0}) {
      for (const double height : {0.2, 0.8}) {
        canvas.disc({joint + side * 0.12 * plank_m, top + height * plank_m}, 0.035 * plank_m, dark);
      }
    }
    const int knots = 1 + random.below(4);
    for (int k = 0; k < knots; ++k) {
      const Vector2d at(random.uniform(0.0, spec.tile_m.x()),
                        top + plank_m * random.uniform(0.25, 0.75));
      const double radius = plank_m * random.uniform(0.04, 0.12);
      canvas.ring(at, 1.7 * radius, 0.25 * radius, shade(tones[static_cast<std::size_t>(i)], 0.7));
      canvas.disc(at, radius, dark);
    }
  }
  return canvas;
}

Canvas checker(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, spec.palette.front());
  const int columns = count(spec.tile_m.x(), spec.cell_m);
  const int rows = count(spec.tile_m.y(), spec.cell_m);
  const Vector2d cell(spec.tile_m.x() / columns, spec.tile_m.y() / rows);
  const auto colors = static_cast<int>(spec.palette.size());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Color& base = spec.palette[static_cast<std::size_t>((row + column) % colors)];
      canvas.rectangle({(column + 0.5) * cell.x(), (row + 0.5) * cell.y()}, cell, 0.0,
                       shade(base, random.uniform(0.75, 1.2)));
    }
  }
  return canvas;
}

/// Woven stripes in both directions.
Canvas plaid(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, spec.palette.front());
  const auto stripes = [&](double extent) {
    std::vector<Color> colors;
    const int n = 6 * count(extent, spec.cell_m);
    for (int i = 0; i < n; ++i) colors.push_back(pick(spec.palette, random));
    return colors;
  };
  const std::vector<Color> warp = stripes(spec.tile_m.x());
  const std::vector<Color> weft = stripes(spec.tile_m.y());
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const auto i =
          static_cast<std::size_t>(x) * warp.size() / static_cast<std::size_t>(canvas.width());
      const auto j =
          static_cast<std::size_t>(y) * weft.size() / static_cast<std::size_t>(canvas.height());
      const float over = (x / 2 + y / 2) % 2 == 0 ? 0.7f : 0.3f;
      canvas.at(x, y) = over * warp[i] + (1.0f - over) * weft[j];
    }
  }
  return canvas;
}

/// Clouds that run through the palette, as in stone or plaster.
Canvas clouds(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, spec.palette.front());
  const auto noise =
      fractal_noise_tile(canvas.width(), canvas.height(), count(spec.tile_m.x(), spec.cell_m),
                         count(spec.tile_m.y(), spec.cell_m), 8, 0.65f, random.bits());
  const auto last = static_cast<float>(spec.palette.size() - 1);
  std::size_t texel = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x, ++texel) {
      const float stretched = std::clamp(0.5f + 2.2f * (noise[texel] - 0.5f), 0.0f, 1.0f);
      const float at = stretched * last;
      const auto lower = static_cast<std::size_t>(at);
      const std::size_t upper = std::min(lower + 1, spec.palette.size() - 1);
      const float blend = at - static_cast<float>(lower);
      canvas.at(x, y) = spec.palette[lower] + blend * (spec.palette[upper] - spec.palette[lower]);
    }
  }
  return canvas;
}

Canvas paint_pattern(const TextureSpec& spec, Random& random) {
  switch (spec.pattern) {
    case Pattern::Noise:
      return clouds(spec, random);
    case Pattern::Wood:
      return wood(spec, random);
    case Pattern::Checker:
      return checker(spec, random);
    case Pattern::Bricks:
      return paint_bricks(spec, random);
    case Pattern::Facade:
      return paint_facade(spec, random);
    case Pattern::Poster:
      return poster(spec, random);
    case Pattern::Books:
      return paint_books(spec, random);
    case Pattern::Plaid:
      return plaid(spec, random);
    case Pattern::Plain:
      break;
  }
  return Canvas(spec, spec.palette.front());
}

/// Brightness noise from a quarter of a cell down to the texel, and specks: corners at every scale.
void add_grain(Canvas& canvas, const TextureSpec& spec, Random& random) {
  if (spec.grain <= 0.0) return;
  const double coarsest = 0.25 * spec.cell_m;
  const auto noise =
      fractal_noise_tile(canvas.width(), canvas.height(), count(spec.tile_m.x(), coarsest),
                         count(spec.tile_m.y(), coarsest), 8, 0.9f, random.bits());
  std::size_t texel = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x, ++texel) {
      const double contrast = 4.0 * spec.grain * (static_cast<double>(noise[texel]) - 0.5);
      canvas.at(x, y) = shade(canvas.at(x, y), 1.0 + contrast);
    }
  }
  const int specks = std::min(3000, count(12.0 * spec.tile_m.prod(), spec.cell_m * spec.cell_m));
  for (int i = 0; i < specks; ++i) {
    const Vector2d at(random.uniform(0.0, spec.tile_m.x()), random.uniform(0.0, spec.tile_m.y()));
    const double radius = spec.cell_m * 0.03 * random.uniform(0.3, 1.0);
    const double change = random.uniform() < 0.6 ? 1.0 - 1.6 * spec.grain : 1.0 + 1.6 * spec.grain;
    const int x = static_cast<int>(at.x() / canvas.size_m().x() * canvas.width());
    const int y = static_cast<int>(at.y() / canvas.size_m().y() * canvas.height());
    const Color speck =
        shade(canvas.at(std::min(x, canvas.width() - 1), std::min(y, canvas.height() - 1)), change);
    canvas.disc(at, radius, speck);
  }
}

}  // namespace

LinearImage Canvas::linear() const {
  const std::array<float, 256>& table = linear_from_srgb_byte_table();
  LinearImage result(image_.width, image_.height);
  for (std::size_t i = 0; i < image_.pixels.size(); ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const float srgb = std::clamp(image_.pixels[i][c], 0.0f, 1.0f);
      result.pixels[i][c] = table[static_cast<std::size_t>(srgb * 255.0f + 0.5f)];
    }
  }
  return result;
}

LinearImage paint_texture(const TextureSpec& spec) {
  Random random(spec.seed);
  Canvas canvas = paint_pattern(spec, random);
  add_grain(canvas, spec, random);
  return canvas.linear();
}

}  // namespace lumibox::hal::sim
