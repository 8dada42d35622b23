#include "hal/sim/pattern_tools.h"

namespace lumibox::hal::sim {

using Eigen::Vector2d;

namespace {

/// One window with frame, panes, curtain or blind, sill and lintel.
void window(Canvas& canvas, const Vector2d& center, const Vector2d& size, const TextureSpec& spec,
            Random& random) {
  const Color frame = shade(spec.palette.front(), random.uniform(1.15, 1.3));
  const Color glass = shade(Color(0.20f, 0.25f, 0.32f), random.uniform(0.6, 1.6));
  canvas.rectangle(center, 1.12 * size, 0.0, shade(spec.palette.front(), 0.6));
  canvas.rectangle(center, size, 0.0, frame);
  for (const double x : {-0.25, 0.25}) {
    for (const double y : {-0.22, 0.22}) {
      canvas.rectangle(center + size.cwiseProduct(Vector2d(x, y)),
                       size.cwiseProduct(Vector2d(0.42, 0.38)), 0.0,
                       shade(glass, random.uniform(0.8, 1.25)));
    }
  }
  if (random.uniform() < 0.5) {  // a blind let down to some height, slat by slat
    const double depth = random.uniform(0.2, 0.9);
    const Color slat = shade(pick(spec.palette, random), random.uniform(0.8, 1.2));
    for (double y = -0.45; y < -0.45 + 0.9 * depth; y += 0.075) {
      canvas.rectangle(center + size.cwiseProduct(Vector2d(0.0, y)),
                       size.cwiseProduct(Vector2d(0.9, 0.05)), 0.0, slat);
    }
  }
  canvas.rectangle(center + Vector2d(0.0, 0.57 * size.y()), size.cwiseProduct(Vector2d(1.3, 0.08)),
                   0.0, shade(frame, 0.95));
  canvas.rectangle(center - Vector2d(0.0, 0.6 * size.y()), size.cwiseProduct(Vector2d(1.2, 0.1)),
                   0.0, shade(pick(spec.palette, random), 0.8));
}

}  // namespace

Canvas paint_bricks(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, spec.palette.front());
  const int columns = count(spec.tile_m.x(), spec.cell_m);
  const int rows = 2 * count(spec.tile_m.y(), 0.7 * spec.cell_m);
  const Vector2d cell(spec.tile_m.x() / columns, spec.tile_m.y() / rows);
  const double joint = 0.12 * cell.y();
  const std::vector<Color> clays(
      spec.palette.size() > 1 ? spec.palette.begin() + 1 : spec.palette.begin(),
      spec.palette.end());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double shift = row % 2 == 0 ? 0.5 : 1.0;
      canvas.rectangle({(column + shift) * cell.x(), (row + 0.5) * cell.y()},
                       cell - Vector2d(joint, joint), random.uniform(-0.01, 0.01),
                       shade(pick(clays, random), random.uniform(0.7, 1.2)));
    }
  }
  return canvas;
}

Canvas paint_facade(const TextureSpec& spec, Random& random) {
  TextureSpec masonry = spec;
  masonry.cell_m = 0.16 * spec.cell_m;
  Canvas canvas = paint_bricks(masonry, random);
  const int columns = count(spec.tile_m.x(), spec.cell_m);
  const int floors = count(spec.tile_m.y(), 1.2 * spec.cell_m);
  const Vector2d cell(spec.tile_m.x() / columns, spec.tile_m.y() / floors);
  for (int floor = 0; floor < floors; ++floor) {
    canvas.rectangle({0.5 * spec.tile_m.x(), floor * cell.y()}, {spec.tile_m.x(), 0.07 * cell.y()},
                     0.0, shade(spec.palette.front(), 1.1));
    canvas.rectangle({0.5 * spec.tile_m.x(), (floor + 0.045) * cell.y()},
                     {spec.tile_m.x(), 0.02 * cell.y()}, 0.0, shade(spec.palette.front(), 0.55));
    for (int column = 0; column < columns; ++column) {
      window(canvas, {(column + 0.5) * cell.x(), (floor + 0.52) * cell.y()},
             cell.cwiseProduct(Vector2d(0.44, 0.5)), spec, random);
    }
  }
  return canvas;
}

Canvas paint_books(const TextureSpec& spec, Random& random) {
  Canvas canvas(spec, shade(spec.palette.front(), 0.25));
  const int shelves = count(spec.tile_m.y(), 1.25 * spec.cell_m);
  const double shelf_m = spec.tile_m.y() / shelves;
  for (int shelf = 0; shelf < shelves; ++shelf) {
    const double floor = (shelf + 0.93) * shelf_m;
    double x = 0.0;
    while (x < spec.tile_m.x()) {
      const double width = std::min(spec.cell_m * random.uniform(0.08, 0.26), spec.tile_m.x() - x);
      const double height = spec.cell_m * random.uniform(0.75, 1.05);
      const Color cover = shade(pick(spec.palette, random), random.uniform(0.55, 1.15));
      const Vector2d center(x + 0.5 * width, floor - 0.5 * height);
      canvas.rectangle(center, {0.94 * width, height}, 0.0, cover);
      const Color ink = luminance(cover) > 0.4f ? shade(cover, 0.25) : Color(0.92f, 0.88f, 0.7f);
      for (const double band : {-0.42, -0.36, 0.4}) {
        canvas.rectangle(center + Vector2d(0.0, band * height), {0.94 * width, 0.015 * height}, 0.0,
                         ink);
      }
      const double letter = 0.5 * width;
      for (double y = -0.28; y < random.uniform(-0.1, 0.3); y += 1.4 * letter / height) {
        glyph(canvas, center + Vector2d(-0.35 * letter, y * height), letter, ink, random);
      }
      x += width;
    }
    canvas.rectangle({0.5 * spec.tile_m.x(), (shelf + 0.965) * shelf_m},
                     {spec.tile_m.x(), 0.07 * shelf_m}, 0.0, shade(spec.palette.front(), 0.9));
  }
  return canvas;
}

}  // namespace lumibox::hal::sim
