#include <cmath>
#include <numbers>

#include "geometry/rotation.h"
#include "hal/sim/random_objects.h"
#include "hal/sim/random_textures.h"

namespace lumibox::hal::sim {
namespace {

using Eigen::Vector3d;

constexpr double kTexel_m = 0.0006;  // about what a camera at arm's length resolves

double any_angle(Random& random) {
  return random.uniform(-std::numbers::pi, std::numbers::pi);
}

ObjectSpec& add(SceneSpec& scene, const std::string& name, Shape shape, const Vector3d& size,
                const Vector3d& at, const std::string& texture) {
  ObjectSpec object;
  object.name = name;
  object.shape = shape;
  object.size = size;
  object.segments = 64;
  object.world_from_object.translation = at;
  object.texture = texture;
  scene.objects.push_back(object);
  return scene.objects.back();
}

/// Lumps on top of each other, as an animal or a doll: body, head, ears, limbs.
double add_figure(SceneSpec& scene, Random& random) {
  const double body = random.uniform(0.09, 0.16);
  const double head = body * random.uniform(0.6, 0.95);
  scene.textures.push_back(random_texture("fur", {Pattern::Noise, Pattern::Plaid, Pattern::Poster},
                                          3.0 * body, 2.0 * body, kTexel_m, random));
  const auto lump = [&](const std::string& name, const Vector3d& size, const Vector3d& at) {
    ObjectSpec& object = add(scene, name, Shape::Sphere, size, at, "fur");
    object.displacement = {0.04 * size.minCoeff(), 0.25 * size.minCoeff(), random.bits() >> 40};
  };
  lump("body", {body, 0.9 * body, 1.2 * body}, {0.0, 0.0, 0.6 * body});
  const double neck = 1.1 * body;
  lump("head", {head, 0.9 * head, 0.9 * head}, {0.0, -0.1 * body, neck + 0.35 * head});
  for (const double side : {-1.0, 1.0}) {
    const std::string which = side < 0.0 ? " left" : " right";
    lump("ear" + which, {0.4 * head, 0.2 * head, random.uniform(0.4, 0.9) * head},
         {0.35 * side * head, 0.0, neck + 0.75 * head});
    lump("arm" + which, {0.35 * body, 0.35 * body, 0.8 * body},
         {0.5 * side * body, -0.2 * body, 0.75 * body});
    lump("leg" + which, {0.4 * body, 0.8 * body, 0.4 * body},
         {0.35 * side * body, -0.5 * body, 0.2 * body});
  }
  return neck + 1.1 * head;
}

double add_stack_of_boxes(SceneSpec& scene, Random& random) {
  const int boxes = 2 + random.below(3);
  double top = 0.0;
  double width = random.uniform(0.12, 0.2);
  for (int i = 0; i < boxes; ++i) {
    const std::string name = "box " + std::to_string(i);
    const Vector3d size(width, width * random.uniform(0.6, 1.0), random.uniform(0.03, 0.09));
    scene.textures.push_back(
        random_texture(name, {Pattern::Poster, Pattern::Checker, Pattern::Books, Pattern::Wood},
                       2.0 * size.x(), 2.0 * size.x(), kTexel_m, random));
    ObjectSpec& box = add(scene, name, Shape::Box, size, {0.0, 0.0, top + 0.5 * size.z()}, name);
    box.world_from_object.rotation = about_z(any_angle(random));
    top += size.z() + 0.0005;
    width *= random.uniform(0.7, 0.95);
  }
  return top;
}

/// A bellied vessel turned on a wheel; outside, rim, inside.
double add_vase(SceneSpec& scene, Random& random) {
  const double height = random.uniform(0.14, 0.28);
  const double foot = random.uniform(0.03, 0.05);
  const double belly = random.uniform(0.05, 0.08);
  const double mouth = random.uniform(0.025, 0.05);
  const double wall = 0.004;
  scene.textures.push_back(random_texture(
      "glaze", {Pattern::Poster, Pattern::Plaid, Pattern::Noise, Pattern::Bricks, Pattern::Checker},
      2.0 * std::numbers::pi * belly, 1.5 * height, kTexel_m, random));
  ObjectSpec& vase = add(scene, "vase", Shape::Lathe, Vector3d::Ones(), Vector3d::Zero(), "glaze");
  vase.profile = {{0.0, 0.0},
                  {foot, 0.0},
                  {0.5 * (foot + belly), 0.15 * height},
                  {belly, 0.4 * height},
                  {0.6 * belly + 0.4 * mouth, 0.7 * height},
                  {0.9 * mouth, 0.88 * height},
                  {mouth, height},
                  {mouth - wall, height},
                  {0.9 * mouth - wall, 0.88 * height},
                  {0.0, 0.8 * height}};
  vase.world_from_object.rotation = about_z(any_angle(random));
  return height;
}

/// A pillar with a ring around it and a ball on top.
double add_trophy(SceneSpec& scene, Random& random) {
  const double radius = random.uniform(0.025, 0.05);
  const double height = random.uniform(0.08, 0.16);
  const double ball = random.uniform(1.6, 2.6) * radius;
  for (const char* name : {"pillar", "ring", "ball"}) {
    scene.textures.push_back(
        random_texture(name, {Pattern::Poster, Pattern::Plaid, Pattern::Checker, Pattern::Noise},
                       6.0 * radius, 6.0 * radius, kTexel_m, random));
  }
  add(scene, "pillar", Shape::Cylinder, {2.0 * radius, 2.0 * radius, height},
      {0.0, 0.0, 0.5 * height}, "pillar");
  const double tube = 0.35 * radius;
  const double outer = 2.0 * radius + 3.8 * tube;
  ObjectSpec& ring = add(scene, "ring", Shape::Torus, {outer, outer, 2.0 * tube},
                         {0.0, 0.0, random.uniform(0.3, 0.7) * height}, "ring");
  ring.tube_m = tube;
  ObjectSpec& top = add(scene, "ball", Shape::Sphere, Vector3d::Constant(ball),
                        {0.0, 0.0, height + 0.48 * ball}, "ball");
  top.displacement = {random.uniform(0.0, 0.05) * ball, 0.3 * ball, random.bits() >> 40};
  return height + ball;
}

double add_ball(bool glass, SceneSpec& scene, Random& random) {
  const double size = random.uniform(0.1, 0.2);
  const double foot = random.uniform(0.02, 0.05);
  scene.textures.push_back(random_texture("stand", {Pattern::Wood, Pattern::Poster, Pattern::Noise},
                                          size, size, kTexel_m, random));
  add(scene, "stand", Shape::Cylinder, {0.6 * size, 0.6 * size, foot}, {0.0, 0.0, 0.5 * foot},
      "stand");
  ObjectSpec& ball = add(scene, "ball", Shape::Sphere, Vector3d::Constant(size),
                         {0.0, 0.0, foot + 0.5 * size + 0.001}, "");
  if (glass) {
    ball.glass_ior = random.uniform(1.33, 1.6);
    ball.glass_tint = Color(0.95f, 0.98f, 0.97f);
  } else {
    ball.mirror = 1.0;
  }
  return foot + size;
}

/// A label whose tile goes a whole number of times around, so that it has no seam.
TextureSpec random_label(double around_m, double height_m, Random& random) {
  TextureSpec label =
      random_texture("label", {Pattern::Poster, Pattern::Poster, Pattern::Checker, Pattern::Noise},
                     around_m, height_m, 0.0003, random);
  const double draw = random.uniform();
  const int repeats = draw < 0.7 ? 1 : draw < 0.9 ? 2 : 3;
  label.tile_m = {around_m / repeats, 1.05 * height_m};
  label.cell_m = std::clamp(label.cell_m, label.tile_m.minCoeff() / 12.0, label.tile_m.minCoeff());
  return label;
}

double add_can(SceneSpec& scene, Random& random) {
  const double height = random.uniform(0.09, 0.2);
  const double draw = random.uniform();
  if (draw < 0.2) {  // a carton
    const Vector3d size(random.uniform(0.06, 0.1), random.uniform(0.05, 0.09), height);
    scene.textures.push_back(random_label(2.0 * (size.x() + size.y()), height, random));
    ObjectSpec& carton = add(scene, "carton", Shape::Box, size, {0.0, 0.0, 0.5 * height}, "label");
    carton.world_from_object.rotation = about_z(any_angle(random));
    return height;
  }
  const double radius = random.uniform(0.03, 0.05);
  scene.textures.push_back(random_label(2.0 * std::numbers::pi * radius, height, random));
  scene.textures.push_back(
      random_texture("metal", {Pattern::Noise}, 2.0 * radius, 2.0 * radius, 0.0003, random));
  scene.textures.back().palette = {Color(0.7f, 0.7f, 0.72f), Color(0.82f, 0.82f, 0.84f)};
  ObjectSpec& can = add(scene, "can", Shape::Cylinder, {2.0 * radius, 2.0 * radius, height},
                        {0.0, 0.0, 0.5 * height}, "label");
  can.world_from_object.rotation = about_z(any_angle(random));
  const bool bottle = draw < 0.4;
  const double neck = bottle ? 0.35 * radius : 0.92 * radius;
  const double neck_height = bottle ? 0.4 * height : 0.004;
  add(scene, "lid", Shape::Cylinder, {2.0 * neck, 2.0 * neck, neck_height},
      {0.0, 0.0, height + 0.5 * neck_height}, "metal");
  return height + neck_height;
}

double add_house(SceneSpec& scene, Random& random) {
  const double width = random.uniform(11.0, 17.0);
  const double height = random.uniform(8.0, 13.0);
  scene.textures.push_back(
      random_texture("front", {Pattern::Facade}, width, height, 0.008, random));
  scene.textures.back().cell_m = random.uniform(1.6, 2.4);
  scene.textures.back().tile_m = {width, height};
  add(scene, "house", Shape::Box, {width, 9.0, height}, {0.0, 4.5, 0.5 * height}, "front");
  const int pieces = 4 + random.below(5);
  for (int i = 0; i < pieces; ++i) {  // balconies, signs, bays
    const std::string name = "bay " + std::to_string(i);
    const Vector3d size(random.uniform(1.0, 4.0), random.uniform(0.3, 1.2),
                        random.uniform(0.3, 2.2));
    scene.textures.push_back(random_texture(name, {Pattern::Poster, Pattern::Bricks, Pattern::Wood},
                                            size.x(), size.x(), 0.008, random));
    add(scene, name, Shape::Box, size,
        {random.uniform(-0.4, 0.4) * width, -0.45 * size.y(), random.uniform(0.15, 0.9) * height},
        name);
  }
  return height;
}

double add_thing(Place place, SceneSpec& scene, Random& random) {
  switch (place) {
    case Place::Can:
      return add_can(scene, random);
    case Place::Glass:
    case Place::Mirror:
      return add_ball(place == Place::Glass, scene, random);
    case Place::Facade:
      return add_house(scene, random);
    case Place::Desk:
      break;
  }
  switch (random.below(4)) {
    case 0:
      return add_figure(scene, random);
    case 1:
      return add_stack_of_boxes(scene, random);
    case 2:
      return add_vase(scene, random);
    default:
      return add_trophy(scene, random);
  }
}

}  // namespace

Eigen::Quaterniond about_z(double angle) {
  return geometry::exp_so3(angle * Vector3d::UnitZ());
}

double footprint(const ObjectSpec& object) {
  if (object.shape != Shape::Lathe) return 0.5 * object.size.head<2>().norm();
  double widest = 0.0;
  for (const Eigen::Vector2d& point : object.profile) widest = std::max(widest, point.x());
  return widest;
}

double bounding_radius(const ObjectSpec& object) {
  double radius = 0.0;
  if (object.shape == Shape::Lathe) {
    for (const Eigen::Vector2d& point : object.profile) radius = std::max(radius, point.norm());
  } else {
    radius = 0.5 * object.size.norm();
  }
  return radius + object.displacement.amplitude_m;
}

WalkRoom add_subject(Place place, SceneSpec& scene, Random& random) {
  const double height = add_thing(place, scene, random);
  scene.subject_center = {0.0, 0.0, 0.5 * height};
  WalkRoom room;
  room.target = scene.subject_center;
  if (place == Place::Facade) {
    scene.subject_radius_m = 0.55 * height;
    room.radius_m = {11.0, 16.0};
    // Eyes are 1.7 m above the street.
    const double down = std::asin((1.7 - room.target.z()) / 13.5) * 180.0 / std::numbers::pi;
    room.elevation_deg = {down - 0.8, down + 0.8};
    room.extent_deg = {35.0, 60.0};
    room.most_sweeps = 1;
    room.from_the_front = true;
    return room;
  }
  double widest = 0.0;
  for (const ObjectSpec& object : scene.objects) widest = std::max(widest, footprint(object));
  scene.subject_radius_m = std::max(0.55 * height, widest) + 0.01;
  const double nearest = std::max(place == Place::Can ? 0.28 : 0.42, 2.6 * scene.subject_radius_m);
  room.radius_m = {nearest, 1.6 * nearest};
  room.elevation_deg =
      place == Place::Can ? Eigen::Vector2d(18.0, 55.0) : Eigen::Vector2d(12.0, 55.0);
  return room;
}

}  // namespace lumibox::hal::sim
