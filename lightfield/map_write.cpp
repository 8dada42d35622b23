#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/error.h"
#include "config/input_file.h"
#include "geometry/position.h"
#include "geometry/rotation.h"
#include "hal/image_io.h"
#include "lightfield/map_files.h"
#include "lightfield/map_limits.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {
namespace {

using Json = nlohmann::ordered_json;
using tracking::MapView;

Json to_json(const Eigen::VectorXd& v) {
  return Json(std::vector<double>(v.begin(), v.end()));
}

Json to_json(const config::CameraProfile& c) {
  return {{"model", config::name_of(c.model)},
          {"width", c.width},
          {"height", c.height},
          {"fx", c.fx},
          {"fy", c.fy},
          {"cx", c.cx},
          {"cy", c.cy},
          {"distortion", {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4}},
          {"readout_s", c.readout_s}};
}

Json to_json(const geometry::Similarity& place) {
  const Eigen::Quaterniond q = geometry::canonical(place.rigid.rotation);
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation", to_json(place.rigid.translation)},
          {"scale", place.scale}};
}

Json to_json(const MapView::Keyframe& keyframe) {
  if (keyframe.culled()) {
    return {{"tied_to", keyframe.tied_to}, {"tied_from_this", to_json(keyframe.tied_from_this)}};
  }
  return {{"world_from_this", to_json(keyframe.world_from_keyframe())},
          {"readout_twist", to_json(keyframe.readout_twist)},
          {"median_depth", keyframe.median_depth}};
}

Json to_json(const MapView::Point& point, const MapView& map) {
  Json sightings = Json::array();
  for (std::uint32_t i = 0; i < point.sightings; ++i) {
    const tracking::Sighting& s = map.sightings[point.first_sighting + i];
    sightings.push_back({s.keyframe, s.pixel.x(), s.pixel.y(), s.level});
  }
  return {{"id", point.id},
          {"position", to_json(point.position)},
          {"searched", point.searched},
          {"found", point.found},
          {"sightings", std::move(sightings)}};
}

/// True if what is written will be read again: JSON has no NaN.
bool is_sound(const geometry::Similarity& place) {
  return place.rigid.rotation.coeffs().allFinite() &&
         !geometry::fault_of_position(place.rigid.translation) && is_scale(place.scale);
}

bool is_sound(const MapView::Keyframe& keyframe) {
  if (keyframe.culled()) return is_sound(keyframe.tied_from_this);
  return is_sound(keyframe.world_from_keyframe()) && is_length(keyframe.median_depth) &&
         is_readout_motion(keyframe.readout_twist, keyframe.median_depth);
}

/// Others are worth nothing.
bool is_sound(const MapView::Point& point) {
  return point.position.allFinite() && point.sightings > 0;
}

/// Throws config::InputError if what would be written to `file` would not be read again.
void require_sound(const MapView& map, const std::filesystem::path& file) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (is_sound(map.keyframes[i])) continue;
    throw config::InputError(file, "not written: the pose or the depth of keyframe " +
                                       std::to_string(i) + " is not finite or beyond all bounds");
  }
  const auto sound = [](const MapView::Point& point) { return is_sound(point); };
  if (std::ranges::none_of(map.points, sound)) {
    throw config::InputError(file, "not written: the map has no points");
  }
}

/// One line per keyframe and point: the whole tree of a large map would take memory for nothing.
std::string map_json(const MapView& map, const geometry::Camera& camera) {
  std::string text = "{\n  \"version\": 1,\n  \"camera\": " + to_json(camera.profile()).dump() +
                     ",\n  \"next_point\": " + std::to_string(map.next_point);
  text += ",\n  \"keyframes\": [";
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    text += (i == 0 ? "\n    " : ",\n    ") + to_json(map.keyframes[i]).dump();
  }
  text += "\n  ],\n  \"points\": [";
  const char* between = "\n    ";
  for (const MapView::Point& point : map.points) {
    if (!is_sound(point)) continue;
    text += between + to_json(point, map).dump();
    between = ",\n    ";
  }
  return text + "\n  ]\n}\n";
}

/// Its folder may not have been synced though it is there.
bool holds(const std::filesystem::path& file, const std::string& text) {
  try {
    return config::read_text(file) == text;
  } catch (const config::InputError&) {
    return false;
  }
}

}  // namespace

std::string map_picture_file(tracking::KeyframeId id) {
  return std::string(kMapFolder) + "/" + six_digits(id) + ".png";
}

MapWriter::MapWriter(std::filesystem::path capture, std::size_t on_disk)
    : capture_(std::move(capture)) {
  for (std::size_t id = 0; id < on_disk; ++id) {
    pictures_.insert(static_cast<tracking::KeyframeId>(id));
  }
}

void MapWriter::write(const MapView& map, const geometry::Camera& camera,
                      const DurableFiles& files) {
  require_sound(map, capture_ / kMapFile);
  files.make_folder(capture_ / kMapFolder);
  const std::string json = map_json(map, camera);
  std::vector<tracking::KeyframeId> written;
  try {
    write_pictures(map, files, &written);
    files.write(capture_ / kMapFile, json);
  } catch (const config::InputError&) {
    if (!holds(capture_ / kMapFile, json)) forget(written, files);
    throw;
  }
  std::vector<tracking::KeyframeId> culled;
  for (const tracking::KeyframeId id : pictures_) {
    const auto i = static_cast<std::size_t>(id);
    if (i < map.keyframes.size() && map.keyframes[i].culled()) culled.push_back(id);
  }
  forget(culled, files);
}

void MapWriter::write_pictures(const MapView& map, const DurableFiles& files,
                               std::vector<tracking::KeyframeId>* written) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const auto id = static_cast<tracking::KeyframeId>(i);
    if (map.keyframes[i].culled() || pictures_.contains(id)) continue;
    files.write(capture_ / map_picture_file(id),
                hal::encode_png(map.keyframes[i].pyramid->level(0)));
    pictures_.insert(id);
    written->push_back(id);
  }
}

/// Of no map.json, or no more.
void MapWriter::forget(const std::vector<tracking::KeyframeId>& pictures,
                       const DurableFiles& files) {
  for (const tracking::KeyframeId id : pictures) {
    pictures_.erase(id);
    files.remove(capture_ / map_picture_file(id));
  }
}

}  // namespace lumibox::lightfield
