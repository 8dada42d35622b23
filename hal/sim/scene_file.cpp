#include "hal/sim/scene_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>

#include "config/error.h"
#include "config/input_file.h"
#include "geometry/rotation.h"
#include "hal/sim/checked_table.h"
#include "hal/sim/effects_file.h"

namespace lumibox::hal::sim {
namespace {

constexpr Range kColor{0.0, 1.0};
constexpr Range kPositive{1e-6, 1e6};

Color read_srgb(CheckedTable& table, std::string_view key, const std::optional<Color>& fallback) {
  std::optional<Eigen::VectorXd> value;
  if (fallback) value = fallback->matrix().cast<double>();
  return table.numbers(key, 3, kColor, value).cast<float>().array();
}

Eigen::Vector3d read_direction(CheckedTable& table, std::string_view key) {
  const Eigen::Vector3d direction = table.numbers(key, 3, {-1e3, 1e3});
  if (direction.norm() < 1e-9) table.fail(key, "is zero; expected a direction");
  return direction.normalized();
}

config::CameraProfile read_camera(CheckedTable table, double& exposure) {
  config::CameraProfile camera;
  camera.width = table.integer("width", {16, 4096}, camera.width);
  camera.height = table.integer("height", {16, 4096}, camera.height);
  camera.fx = table.number("fx", {1.0, 1e5}, camera.fx);
  camera.fy = table.number("fy", {1.0, 1e5}, camera.fx);
  camera.cx = table.number("cx", {-1e4, 1e4}, 0.5 * (camera.width - 1));
  camera.cy = table.number("cy", {-1e4, 1e4}, 0.5 * (camera.height - 1));
  camera.fps = table.number("fps", {1.0, 1000.0}, camera.fps);
  exposure = table.number("exposure", {1e-3, 1e3}, 1.0);
  table.finish();
  return camera;
}

TextureSpec read_texture(CheckedTable table) {
  constexpr std::array<std::string_view, 9> kPatterns{
      "plain", "noise", "wood", "checker", "bricks", "facade", "poster", "books", "plaid"};
  TextureSpec texture;
  texture.name = table.text("name");
  texture.pattern = static_cast<Pattern>(table.choice("pattern", kPatterns));
  texture.tile_m = table.numbers("tile_m", 2, kPositive, texture.tile_m);
  const Eigen::VectorXd texels = table.numbers("texels", 2, {1.0, 4096.0},
                                               Eigen::Vector2d(texture.texels_x, texture.texels_y));
  texture.texels_x = static_cast<int>(texels[0]);
  texture.texels_y = static_cast<int>(texels[1]);
  for (const double side : texels) {
    if (side != std::floor(side) || !std::has_single_bit(static_cast<unsigned>(side))) {
      table.fail("texels", "expected two powers of two, 1 to 4096");
    }
  }
  texture.cell_m = table.number("cell_m", kPositive, texture.cell_m);
  // Each element is painted one by one: no more of them than a load time allows.
  if (texture.tile_m.maxCoeff() > 400.0 * texture.cell_m) {
    table.fail("cell_m", "is too small: at most 400 cells fit along a tile");
  }
  texture.grain = table.number("grain", {0.0, 1.0}, texture.grain);
  const std::vector<Eigen::VectorXd> palette = table.rows("palette", 3, kColor);
  if (!palette.empty()) texture.palette.clear();
  for (const Eigen::VectorXd& color : palette) {
    texture.palette.emplace_back(color.cast<float>().array());
  }
  texture.seed = static_cast<std::uint64_t>(table.integer("seed", {0, 1e9}, 1));
  table.finish();
  return texture;
}

/// Yaw about z, then pitch about the turned x, then roll about the turned y.
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& turn_deg) {
  const Eigen::Vector3d turn = turn_deg * std::numbers::pi / 180.0;
  return geometry::exp_so3(turn[0] * Eigen::Vector3d::UnitZ()) *
         geometry::exp_so3(turn[1] * Eigen::Vector3d::UnitX()) *
         geometry::exp_so3(turn[2] * Eigen::Vector3d::UnitY());
}

void read_profile(CheckedTable& table, ObjectSpec& object) {
  const bool lathe = object.shape == Shape::Lathe;
  if (!lathe && object.shape != Shape::Extrusion) return;
  for (const Eigen::VectorXd& point : table.rows("profile", 2, {-1e4, 1e4})) {
    object.profile.emplace_back(point);
    if (lathe && point[0] < 0.0) table.fail("profile", "a lathe's radii must not be negative");
  }
  const std::size_t least = lathe ? 2 : 3;
  if (object.profile.size() < least) {
    table.fail("profile", "expected at least " + std::to_string(least) + " points [[a, b], ...]");
  }
}

void read_material(CheckedTable& table, ObjectSpec& object) {
  object.texture = table.text("texture", "");
  object.texture_scale = table.number("texture_scale", {1e-3, 1e3}, 1.0);
  object.mirror = table.number("mirror", {0.0, 1.0}, 0.0);
  if (table.has("glass_ior")) object.glass_ior = table.number("glass_ior", {1.0, 3.0});
  object.glass_tint = read_srgb(table, "glass_tint", object.glass_tint);
}

ObjectSpec read_object(CheckedTable table, const std::filesystem::path& folder) {
  constexpr std::array<std::string_view, 8> kShapes{"quad",  "box",   "sphere",    "cylinder",
                                                    "torus", "lathe", "extrusion", "mesh"};
  ObjectSpec object;
  object.name = table.text("name");
  object.shape = static_cast<Shape>(table.choice("shape", kShapes));
  if (object.shape == Shape::Mesh) {
    object.file = folder / table.text("file");
  } else if (object.shape != Shape::Lathe) {
    object.size = table.numbers("size", 3, {0.0, 1e4});
    const bool flat = object.shape == Shape::Quad;
    if (object.size.head<2>().minCoeff() <= 0.0 || (!flat && object.size.z() <= 0.0)) {
      table.fail("size", "expected three lengths above 0 (a quad's third is not used)");
    }
  }
  if (object.shape == Shape::Torus) {
    object.tube_m = table.number("tube_m", {1e-6, 0.249 * object.size.x()});
  }
  read_profile(table, object);
  object.segments = table.integer("segments", {3, 512}, object.segments);
  if (std::optional<CheckedTable> bumps = table.table("displacement")) {
    object.displacement.amplitude_m = bumps->number("amplitude_m", {0.0, 1e3});
    object.displacement.cell_m = bumps->number("cell_m", kPositive);
    object.displacement.seed = static_cast<std::uint64_t>(bumps->integer("seed", {0, 1e9}, 1));
    bumps->finish();
  }
  object.world_from_object.translation =
      table.numbers("at", 3, {-1e4, 1e4}, Eigen::Vector3d(0.0, 0.0, 0.0));
  object.world_from_object.rotation =
      rotation_of(table.numbers("turn_deg", 3, {-360.0, 360.0}, Eigen::Vector3d(0.0, 0.0, 0.0)));
  read_material(table, object);
  table.finish();
  return object;
}

LightSpec read_light(CheckedTable table) {
  constexpr std::array<std::string_view, 3> kKinds{"ambient", "directional", "point"};
  constexpr std::array<std::string_view, 3> kShadows{"none", "baked", "traced"};
  LightSpec light;
  light.kind = static_cast<LightKind>(table.choice("kind", kKinds));
  const Color color = read_srgb(table, "color", Color(1.0f, 1.0f, 1.0f));
  const double strength = table.number("strength", {0.0, 1e3}, 1.0);
  light.color = linear_from_srgb(color) * static_cast<float>(strength);
  light.shadows = static_cast<Shadows>(table.choice("shadows", kShadows, 0));
  switch (light.kind) {
    case LightKind::Ambient:
      if (light.shadows == Shadows::Traced) {
        table.fail("shadows", "is \"traced\"; an ambient light's are none or baked");
      }
      light.reach_m = table.number("reach_m", kPositive, light.reach_m);
      break;
    case LightKind::Directional:
      light.direction = read_direction(table, "direction");
      light.softness_deg = table.number("softness_deg", {0.0, 45.0}, light.softness_deg);
      break;
    case LightKind::Point:
      light.position = table.numbers("at", 3, {-1e4, 1e4});
      light.falloff_m = table.number("falloff_m", kPositive, light.falloff_m);
      light.softness_deg = table.number("softness_deg", {0.0, 45.0}, light.softness_deg);
      break;
  }
  table.finish();
  return light;
}

OrbitSpec read_orbit(CheckedTable table, Eigen::Vector3d& target) {
  OrbitSpec orbit;
  orbit.azimuth_deg = table.numbers("azimuth_deg", 2, {-1080.0, 1080.0});
  // Straight up there is no upright picture.
  orbit.elevation_deg = table.numbers("elevation_deg", 2, {-80.0, 80.0});
  orbit.rows = table.integer("rows", {1, 100}, 1);
  orbit.radius_m = table.numbers("radius_m", 2, kPositive);
  target = table.numbers("target", 3, {-1e4, 1e4});
  table.finish();
  return orbit;
}

std::vector<KeyPose> read_keys(CheckedTable& path) {
  std::vector<KeyPose> keys;
  for (CheckedTable& table : path.tables("keys")) {
    KeyPose key;
    key.time_s = table.number("time_s", {0.0, 1e5});
    key.position = table.numbers("at", 3, {-1e4, 1e4});
    key.target = table.numbers("target", 3, {-1e4, 1e4});
    const Eigen::Vector3d sight = key.target - key.position;
    if (sight.head<2>().norm() < 1e-3 * std::max(sight.norm(), 1e-6)) {
      table.fail("target",
                 "expected a point that is neither the camera nor straight above or below");
    }
    if (!keys.empty() && key.time_s <= keys.back().time_s) {
      table.fail("time_s", "expected a time later than the key before");
    }
    table.finish();
    keys.push_back(key);
  }
  return keys;
}

PathSpec read_path(CheckedTable table) {
  constexpr WobbleSpec kViolent{.min_hz = 3.0, .max_hz = 6.0};
  PathSpec path;
  if (std::optional<CheckedTable> orbit = table.table("orbit")) {
    path.orbit = read_orbit(*orbit, path.target);
  }
  path.keys = read_keys(table);
  if (path.orbit.has_value() != path.keys.empty()) {
    table.fail("orbit", "expected either [path.orbit] or [[path.keys]]");
  }
  path.lead_in_s = table.number("lead_in_s", {0.0, 100.0}, 0.0);
  path.lead_in_m = table.number("lead_in_m", {0.0, 1e3}, 0.0);
  if (path.lead_in_m > 0.0 && path.lead_in_s <= 0.0) {
    table.fail("lead_in_s", "must be above 0 where lead_in_m is");
  }
  if (std::optional<CheckedTable> tremor = table.table("tremor")) {
    path.tremor = read_wobble(*tremor, path.tremor);
    tremor->finish();
  }
  if (std::optional<CheckedTable> shake = table.table("shake")) {
    path.shake.emplace();
    path.shake->start_s = shake->number("start_s", {0.0, 1e5});
    path.shake->duration_s = shake->number("duration_s", {1e-3, 1e5}, path.shake->duration_s);
    path.shake->wobble = read_wobble(*shake, kViolent);
    shake->finish();
  }
  table.finish();
  return path;
}

CheckedTable required(CheckedTable& root, std::string_view key) {
  std::optional<CheckedTable> table = root.table(key);
  if (!table) root.fail(key, "is missing; expected the table [" + std::string(key) + "]");
  return *table;
}

toml::table parse(const std::filesystem::path& file) {
  try {
    return toml::parse(config::read_text(file), file.string());
  } catch (const toml::parse_error& error) {
    throw config::InputError(file, static_cast<int>(error.source().begin.line),
                             std::string(error.description()));
  }
}

}  // namespace

SceneSpec read_scene_file(const std::filesystem::path& file) {
  const toml::table document = parse(file);
  CheckedTable root(document, file, "scene");
  SceneSpec scene;
  scene.duration_s = root.number("duration_s", {0.01, 3600.0});
  scene.background = linear_from_srgb(read_srgb(root, "background", Color(0.6f, 0.7f, 0.8f)));
  scene.camera = read_camera(required(root, "camera"), scene.exposure);
  CheckedTable subject = required(root, "subject");
  scene.subject_center = subject.numbers("center", 3, {-1e4, 1e4});
  scene.subject_radius_m = subject.number("radius_m", kPositive);
  subject.finish();
  for (CheckedTable& table : root.tables("textures")) {
    scene.textures.push_back(read_texture(table));
  }
  std::vector<CheckedTable> objects = root.tables("objects");
  if (objects.empty()) root.fail("objects", "is missing; expected at least one [[objects]] to see");
  for (CheckedTable& table : objects) {
    scene.objects.push_back(read_object(table, file.parent_path()));
  }
  for (CheckedTable& table : root.tables("lights")) scene.lights.push_back(read_light(table));
  scene.path = read_path(required(root, "path"));
  scene.effects = read_effects(root, scene.camera);
  root.finish();
  check_references(scene, root, objects);
  return scene;
}

}  // namespace lumibox::hal::sim
