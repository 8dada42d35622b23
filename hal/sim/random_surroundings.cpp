#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/rotation.h"
#include "hal/sim/random_objects.h"
#include "hal/sim/random_textures.h"

namespace lumibox::hal::sim {
namespace {

using Eigen::Vector3d;

constexpr double kTexel_m = 0.0008;
constexpr double kFloorUnderDesk_m = -0.75;

/// An object with a texture of its own.
ObjectSpec& add(SceneSpec& scene, Shape shape, const Vector3d& size, const Vector3d& at,
                const TextureSpec& texture) {
  scene.textures.push_back(texture);
  ObjectSpec object;
  object.name = texture.name;
  object.shape = shape;
  object.size = size;
  object.world_from_object.translation = at;
  object.texture = texture.name;
  scene.objects.push_back(object);
  return scene.objects.back();
}

/// A floor as one finds them: linoleum with next to nothing on it, tiles, boards or carpet.
TextureSpec random_floor(Random& random) {
  const double side = random.uniform(1.5, 2.2);
  TextureSpec floor =
      random_texture("floor", {Pattern::Noise, Pattern::Noise, Pattern::Bricks, Pattern::Wood},
                     side, side, kTexel_m, random);
  floor.texels_x = floor.texels_y = 2048;
  floor.tile_m = {side, side};
  floor.cell_m = side * random.uniform(0.03, 0.1);
  if (floor.pattern == Pattern::Noise) {
    floor.palette = random_palette(3, random.uniform(0.05, 0.3), random);
    floor.grain = random.uniform(0.05, 0.25);
  }
  return floor;
}

void add_desk(SceneSpec& scene, Random& random) {
  const double width = random.uniform(1.2, 2.0);
  const double depth = random.uniform(0.9, 1.3);
  ObjectSpec& top = add(scene, Shape::Quad, {width, depth, 0.0}, Vector3d::Zero(),
                        random_texture("desk",
                                       {Pattern::Wood, Pattern::Wood, Pattern::Checker,
                                        Pattern::Noise, Pattern::Plaid, Pattern::Bricks},
                                       width, depth, kTexel_m, random));
  top.segments = 96;
  const Eigen::Quaterniond turn = about_z(random.uniform(-0.5, 0.5));
  top.world_from_object.rotation = turn;
  ObjectSpec board = top;
  board.name = "board";
  board.shape = Shape::Box;
  board.size.z() = 0.04;
  board.world_from_object.translation.z() = -0.0205;
  scene.objects.push_back(board);
}

void add_walls(double distance_m, SceneSpec& scene, Random& random) {
  constexpr double kHeight_m = 2.6;
  for (int side = 0; side < 4; ++side) {
    const double angle = 0.5 * std::numbers::pi * side;
    const Eigen::Quaterniond turn = about_z(angle);
    TextureSpec texture = random_texture(
        "wall " + std::to_string(side),
        {Pattern::Poster, Pattern::Books, Pattern::Bricks, Pattern::Wood, Pattern::Noise},
        2.0 * distance_m, kHeight_m, 0.002, random);
    ObjectSpec& wall =
        add(scene, Shape::Quad, {2.0 * distance_m, kHeight_m, 0.0},
            turn * Vector3d(0.0, distance_m, kFloorUnderDesk_m + 0.5 * kHeight_m), texture);
    // Upright, and facing inwards.
    wall.world_from_object.rotation =
        turn * geometry::exp_so3(0.5 * std::numbers::pi * Vector3d::UnitX());
    const Vector3d size(random.uniform(0.5, 1.4), random.uniform(0.3, 0.5),
                        random.uniform(0.6, 1.9));
    const double along = random.uniform(-0.5, 0.5) * distance_m;
    ObjectSpec& cupboard = add(scene, Shape::Box, size,
                               turn * Vector3d(along, distance_m - 0.5 * size.y() - 0.01,
                                               kFloorUnderDesk_m + 0.5 * size.z()),
                               random_texture("cupboard " + std::to_string(side),
                                              {Pattern::Wood, Pattern::Books, Pattern::Poster},
                                              size.x(), size.z(), 0.002, random));
    cupboard.world_from_object.rotation = turn;
  }
}

void add_street(SceneSpec& scene, Random& random) {
  ObjectSpec& ground =
      add(scene, Shape::Quad, {70.0, 40.0, 0.0}, {0.0, -12.0, 0.0},
          random_texture("street", {Pattern::Bricks, Pattern::Noise}, 7.0, 7.0, 0.004, random));
  ground.segments = 80;
  const double edge = 0.5 * scene.objects.front().size.x();
  for (const double side : {-1.0, 1.0}) {
    const Vector3d size(random.uniform(11.0, 15.0), 9.0, random.uniform(7.0, 12.0));
    const double setback = random.uniform(0.0, 1.2);
    TextureSpec texture = random_texture(side < 0.0 ? "left neighbour" : "right neighbour",
                                         {Pattern::Facade}, size.x(), size.z(), 0.01, random);
    texture.cell_m = random.uniform(1.6, 2.4);
    const double gap = random.uniform(0.05, 1.0);
    add(scene, Shape::Box, size,
        {side * (edge + gap + 0.5 * size.x()), 4.5 + setback, 0.5 * size.z()}, texture);
  }
  const int trees = random.below(4);
  for (int i = 0; i < trees; ++i) {
    const std::string which = std::to_string(i);
    const Vector3d foot(random.uniform(-14.0, 14.0), random.uniform(-5.0, -2.5), 0.0);
    const double crown = random.uniform(1.5, 3.0);
    add(scene, Shape::Cylinder, {0.3, 0.3, 3.4}, foot + Vector3d(0.0, 0.0, 1.7),
        random_texture("trunk " + which, {Pattern::Wood}, 1.0, 3.4, 0.01, random));
    ObjectSpec& leaves =
        add(scene, Shape::Sphere, {crown, crown, 1.2 * crown}, foot + Vector3d(0.0, 0.0, 4.0),
            random_texture("crown " + which, {Pattern::Noise}, 2.0 * crown, crown, 0.01, random));
    leaves.displacement = {0.15 * crown, 0.3 * crown, random.bits() >> 40};
  }
}

/// One of the small things that lie about, standing on z = 0.
ObjectSpec random_thing(const std::string& name, SceneSpec& scene, Random& random) {
  ObjectSpec thing;
  thing.name = name;
  const double width = random.uniform(0.04, 0.12);
  switch (random.below(5)) {
    case 0:
      thing.shape = Shape::Box;
      thing.size = {width, width * random.uniform(0.4, 1.0), random.uniform(0.03, 0.12)};
      break;
    case 1:  // a book that lies
      thing.shape = Shape::Box;
      thing.size = {random.uniform(0.12, 0.24), random.uniform(0.1, 0.17),
                    random.uniform(0.01, 0.04)};
      break;
    case 2:
      thing.shape = Shape::Cylinder;
      thing.size = {width, width, random.uniform(0.04, 0.12)};
      break;
    case 3:
      thing.shape = Shape::Sphere;
      thing.size = Vector3d::Constant(width);
      thing.displacement = {random.uniform(0.0, 0.06) * width, 0.3 * width, random.bits() >> 40};
      break;
    default:
      thing.shape = Shape::Torus;
      thing.tube_m = 0.18 * width;
      thing.size = {width, width, 2.0 * thing.tube_m};
  }
  const double side = std::max(thing.size.maxCoeff(), 0.06);
  scene.textures.push_back(random_texture(name,
                                          {Pattern::Poster, Pattern::Plaid, Pattern::Checker,
                                           Pattern::Noise, Pattern::Wood, Pattern::Books},
                                          2.0 * side, 2.0 * side, kTexel_m, random));
  thing.texture = name;
  return thing;
}

/// Whether the thing leaves room for the camera and, for most of the walk, its view of the subject.
bool out_of_the_way(const ObjectSpec& thing, const SceneSpec& scene) {
  constexpr double kClearance_m = 0.1;
  constexpr double kShareHidden = 0.15;
  const Vector3d& center = thing.world_from_object.translation;
  const double radius = bounding_radius(thing);
  std::size_t hidden = 0;
  for (const KeyPose& key : scene.path.keys) {
    if ((key.position - center).norm() < radius + kClearance_m) return false;
    const Vector3d sight = scene.subject_center - key.position;
    const double along =
        std::clamp((center - key.position).dot(sight) / sight.squaredNorm(), 0.0, 1.0);
    if ((key.position + along * sight - center).norm() < radius) ++hidden;
  }
  return static_cast<double>(hidden) <= kShareHidden * static_cast<double>(scene.path.keys.size());
}

}  // namespace

void add_surroundings(Place place, const WalkRoom& room, SceneSpec& scene, Random& random) {
  scene.background = Color(static_cast<float>(random.uniform(0.3, 0.6)),
                           static_cast<float>(random.uniform(0.35, 0.6)),
                           static_cast<float>(random.uniform(0.4, 0.7)));
  if (place == Place::Facade) {
    add_street(scene, random);
    return;
  }
  const double height = place == Place::Can ? 0.0 : kFloorUnderDesk_m;
  ObjectSpec& floor =
      add(scene, Shape::Quad, {6.0, 6.0, 0.0}, {0.0, 0.0, height}, random_floor(random));
  floor.segments = 96;
  if (place == Place::Can) return;
  add_desk(scene, random);
  // A ball shows nothing without things around it.
  const bool indoors = place != Place::Desk || random.uniform() < 0.75;
  if (indoors) add_walls(room.radius_m[1] + random.uniform(0.9, 1.7), scene, random);
}

void add_clutter(int count, SceneSpec& scene, Random& random) {
  constexpr int kAttempts = 20;
  constexpr double kReach_m = 0.45;  // of the smallest desk
  std::vector<ObjectSpec> placed;
  bool mirror = scene.effects.reflection.has_value();
  bool glass = scene.effects.refraction.has_value();
  for (const ObjectSpec& object : scene.objects) {
    if (object.mirror > 0.0) mirror = false;
    if (object.glass_ior) glass = false;
  }
  for (int i = 0; i < count; ++i) {
    ObjectSpec thing = random_thing("thing " + std::to_string(i), scene, random);
    if (mirror || glass) {
      thing.shape = Shape::Sphere;
      thing.size = Vector3d::Constant(random.uniform(0.06, 0.1));
      thing.displacement = {};
    }
    const double size = footprint(thing);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
      const double nearest = scene.subject_radius_m + size + 0.01;
      const double distance = random.uniform(nearest, std::max(nearest, kReach_m - size));
      thing.world_from_object.translation = {distance * std::cos(angle), distance * std::sin(angle),
                                             0.5 * thing.size.z() + 0.0005};
      thing.world_from_object.rotation = about_z(random.uniform(-3.0, 3.0));
      const bool free = std::ranges::all_of(placed, [&](const ObjectSpec& other) {
        const Vector3d apart =
            other.world_from_object.translation - thing.world_from_object.translation;
        return apart.head<2>().norm() > size + footprint(other);
      });
      if (!free || !out_of_the_way(thing, scene)) continue;
      if (mirror) {
        thing.mirror = 1.0;
        mirror = false;
      } else if (glass) {
        thing.glass_ior = 1.5;
        glass = false;
      }
      placed.push_back(thing);
      break;
    }
  }
  scene.objects.insert(scene.objects.end(), placed.begin(), placed.end());
}

}  // namespace lumibox::hal::sim
