#include <algorithm>
#include <set>

#include "config/error.h"
#include "geometry/position.h"
#include "hal/image_io.h"
#include "lightfield/json_value.h"
#include "lightfield/map_files.h"
#include "lightfield/map_limits.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using tracking::KeyframeId;
using tracking::MapView;
using tracking::PointId;
using tracking::Pyramid;
using tracking::Sighting;

constexpr double kRotationTolerance = 1e-6;  // of a norm: what is ours is exact to rounding
constexpr long long kMost = 1LL << 30;       // ids and counts; far beyond any map

Eigen::Vector3d read_position(const JsonValue& value) {
  const Eigen::Vector3d position = value.numbers(3);
  if (const auto fault = geometry::fault_of_position(position)) value.fail("has " + *fault);
  return position;
}

/// A map is of use to the camera that it was made with alone: a picture's points lie elsewhere in
/// one of another lens.
void require_same_camera(const JsonValue& saved, const config::CameraProfile& c) {
  const std::string model = config::name_of(c.model);
  if (saved.at("model").text() != model) {
    saved.at("model").fail("is " + printable(saved.at("model").text()) + ", but the camera's is " +
                           model + "; expected the camera that the map was made with");
  }
  const auto require = [](const JsonValue& value, double ours) {
    if (value.number() == ours) return;
    value.fail("is " + to_text(value.number()) + ", but the camera's is " + to_text(ours) +
               "; expected the camera that the map was made with");
  };
  require(saved.at("width"), c.width);
  require(saved.at("height"), c.height);
  require(saved.at("fx"), c.fx);
  require(saved.at("fy"), c.fy);
  require(saved.at("cx"), c.cx);
  require(saved.at("cy"), c.cy);
  const std::vector<JsonValue> distortion = saved.at("distortion").items();
  const std::vector<double> ours = {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4};
  if (distortion.size() != ours.size()) saved.at("distortion").fail("expected 6 numbers");
  for (std::size_t i = 0; i < ours.size(); ++i) require(distortion[i], ours[i]);
  require(saved.at("readout_s"), c.readout_s);
}

std::shared_ptr<const Pyramid> read_picture(const fs::path& file, const geometry::Camera& camera,
                                            int levels) {
  const hal::ImageInfo info = hal::read_image_info(file);
  if (info.width != camera.width() || info.height != camera.height() || info.channels != 1) {
    throw config::InputError(
        file, "is a picture of " + std::to_string(info.width) + "x" + std::to_string(info.height) +
                  " pixels in " + std::to_string(info.channels) + " channels; expected " +
                  std::to_string(camera.width()) + "x" + std::to_string(camera.height()) +
                  " in 1, as the map's camera has");
  }
  return std::make_shared<const Pyramid>(hal::read_image(file), levels);
}

double read_length(const JsonValue& value) {
  const double length = value.number();
  if (!is_length(length)) value.fail("is " + to_text(length) + ", expected more than 0, up to 1e9");
  return length;
}

double read_scale(const JsonValue& value) {
  const double scale = value.number();
  if (!is_scale(scale)) value.fail("is " + to_text(scale) + ", expected 0.001 to 1000");
  return scale;
}

geometry::Vector6d read_readout_motion(const JsonValue& value, double median_depth) {
  const geometry::Vector6d twist = value.numbers(6);
  if (!is_readout_motion(twist, median_depth)) {
    value.fail("is a motion of " + to_text(twist.head<3>().stableNorm()) + " and a turn of " +
               to_text(twist.tail<3>().stableNorm()) +
               " rad, expected at most 1000 median depths of " + to_text(median_depth) +
               ", and half a turn");
  }
  return twist;
}

geometry::Similarity read_place(const JsonValue& value) {
  const Eigen::VectorXd q = value.at("rotation_wxyz").numbers(4);
  if (!(std::abs(q.norm() - 1.0) <= kRotationTolerance)) {
    value.at("rotation_wxyz").fail("is not a unit quaternion");
  }
  // Not normalised: the map goes on from the very bits that it had.
  return {read_scale(value.at("scale")),
          {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), read_position(value.at("translation"))}};
}

/// All but the picture; of a culled one the place is not known yet.
MapView::Keyframe read_keyframe(const JsonValue& value, std::size_t keyframes) {
  MapView::Keyframe keyframe;
  if (value.has("tied_to")) {
    const auto last = static_cast<long long>(keyframes) - 1;
    keyframe.tied_to = static_cast<KeyframeId>(value.at("tied_to").integer(0, last));
    keyframe.tied_from_this = read_place(value.at("tied_from_this"));
    return keyframe;
  }
  const geometry::Similarity place = read_place(value.at("world_from_this"));
  keyframe.world_from_camera = place.rigid;
  keyframe.camera_from_world = place.rigid.inverse();
  keyframe.scale = place.scale;
  keyframe.median_depth = read_length(value.at("median_depth"));
  keyframe.readout_twist = read_readout_motion(value.at("readout_twist"), keyframe.median_depth);
  return keyframe;
}

std::vector<MapView::Keyframe> read_keyframes(const JsonValue& list, const fs::path& capture,
                                              const geometry::Camera& camera, int levels) {
  const std::vector<JsonValue> values = list.items();
  std::vector<MapView::Keyframe> keyframes;
  for (const JsonValue& value : values) keyframes.push_back(read_keyframe(value, values.size()));
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    MapView::Keyframe& keyframe = keyframes[i];
    if (keyframe.tied_to < 0) {
      const auto id = static_cast<KeyframeId>(i);
      keyframe.pyramid = read_picture(capture / map_picture_file(id), camera, levels);
      continue;
    }
    const MapView::Keyframe& tie = keyframes[static_cast<std::size_t>(keyframe.tied_to)];
    if (tie.tied_to >= 0) values[i].at("tied_to").fail("is itself tied to another");
    const geometry::Similarity place = tie.world_from_keyframe() * keyframe.tied_from_this;
    keyframe.world_from_camera = place.rigid;
    keyframe.camera_from_world = place.rigid.inverse();
    keyframe.scale = place.scale;
  }
  return keyframes;
}

Sighting read_sighting(const JsonValue& value, const MapView& map, const geometry::Camera& camera) {
  const std::vector<JsonValue> fields = value.items();
  if (fields.size() != 4) value.fail("expected keyframe, x, y and level");
  Sighting sighting;
  const auto keyframes = static_cast<long long>(map.keyframes.size());
  sighting.keyframe = static_cast<KeyframeId>(fields[0].integer(0, keyframes - 1));
  sighting.pixel = {fields[1].number(), fields[2].number()};
  // A match may end a fraction of a pixel beyond the outermost centres.
  if (!camera.contains(sighting.pixel, -1.0)) value.fail("lies outside the picture");
  const MapView::Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(sighting.keyframe)];
  if (keyframe.culled()) value.fail("is in a keyframe that is tied to another");
  sighting.level = static_cast<int>(fields[3].integer(0, keyframe.pyramid->levels() - 1));
  return sighting;
}

void read_point(const JsonValue& value, const geometry::Camera& camera, MapView* map) {
  MapView::Point point;
  const PointId first = map->points.empty() ? 0 : map->points.back().id + 1;
  point.id = static_cast<PointId>(value.at("id").integer(first, kMost - 1));
  point.position = value.at("position").numbers(3);  // may be as good as infinitely far away
  point.searched = static_cast<int>(value.at("searched").integer(0, kMost));
  point.found = static_cast<int>(value.at("found").integer(0, point.searched));
  point.first_sighting = static_cast<std::uint32_t>(map->sightings.size());
  std::set<KeyframeId> seen;
  for (const JsonValue& item : value.at("sightings").items()) {
    const Sighting sighting = read_sighting(item, *map, camera);
    if (!seen.insert(sighting.keyframe).second) item.fail("is the second in its keyframe");
    ++map->keyframes[static_cast<std::size_t>(sighting.keyframe)].points;
    map->sightings.push_back(sighting);
    ++point.sightings;
  }
  if (point.sightings == 0) value.at("sightings").fail("is empty");
  map->points.push_back(point);
}

}  // namespace

MapView read_map(const fs::path& capture, const geometry::Camera& camera, int levels) {
  const JsonFile json(capture / kMapFile);
  const JsonValue top = json.root();
  top.at("version").integer(1, 1);
  require_same_camera(top.at("camera"), camera.profile());
  MapView map;
  map.next_point = static_cast<PointId>(top.at("next_point").integer(0, kMost));
  map.keyframes = read_keyframes(top.at("keyframes"), capture, camera, levels);
  if (std::ranges::all_of(map.keyframes, &MapView::Keyframe::culled)) {
    top.at("keyframes").fail("has none with a picture");
  }
  for (const JsonValue& value : top.at("points").items()) read_point(value, camera, &map);
  if (map.points.empty()) top.at("points").fail("is empty, expected what the tracker goes by");
  if (const PointId last = map.points.back().id; last >= map.next_point) {
    top.at("next_point")
        .fail("is " + std::to_string(map.next_point) + ", but there is a point of id " +
              std::to_string(last) + "; expected more than every id");
  }
  return map;
}

}  // namespace lumibox::lightfield
