#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "config/error.h"
#include "geometry/rotation.h"
#include "lightfield/camera_io.h"
#include "lightfield/opengl_axes.h"
#include "lightfield/text_numbers.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {
namespace {

using Json = nlohmann::ordered_json;

void add_intrinsics(const config::CameraProfile& c, Json* json) {
  (*json)["w"] = c.width;
  (*json)["h"] = c.height;
  (*json)["fl_x"] = c.fx;
  (*json)["fl_y"] = c.fy;
  (*json)["cx"] = c.cx + kForeignPixelCentre;
  (*json)["cy"] = c.cy + kForeignPixelCentre;
  (*json)["k1"] = c.k1;
  (*json)["k2"] = c.k2;
  if (c.model == config::LensModel::Fisheye) {
    (*json)["k3"] = c.k3;
    (*json)["k4"] = c.k4;
    return;
  }
  if (c.k3 != 0.0) (*json)["k3"] = c.k3;
  (*json)["p1"] = c.p1;
  (*json)["p2"] = c.p2;
}

Json to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json to_json(const Eigen::Matrix4d& matrix) {
  Json rows = Json::array();
  for (int r = 0; r < 4; ++r) {
    rows.push_back({matrix(r, 0), matrix(r, 1), matrix(r, 2), matrix(r, 3)});
  }
  return rows;
}

Json to_json(const Sphere& sphere) {
  Json json{{"center", to_json(sphere.center)}, {"radius", sphere.radius}};
  if (sphere.keyframe >= 0) {
    json["keyframe"] = sphere.keyframe;
    json["center_in_keyframe"] = to_json(sphere.center_in_keyframe);
  }
  return json;
}

/// What nerfstudio does not know of a perspective. The keyframe's pose is a quaternion and keeps
/// the design's camera axes: it is read by us alone.
Json own_keys(const Perspective& perspective) {
  Json own{{"id", perspective.id}, {"timestamp_ns", perspective.timestamp_ns}};
  if (perspective.keyframe >= 0) {
    const Eigen::Quaterniond q = geometry::canonical(perspective.keyframe_from_camera.rotation);
    own["keyframe"] = perspective.keyframe;
    own["keyframe_from_camera"] = {
        {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
        {"translation", to_json(perspective.keyframe_from_camera.translation)}};
  }
  return own;
}

Json to_json(const Perspective& perspective, bool own_intrinsics, OwnKeys keys) {
  Json frame{{"file_path", perspective.file},
             {"timestamp", static_cast<double>(perspective.timestamp_ns) * 1e-9}};
  if (own_intrinsics) add_intrinsics(perspective.camera->profile(), &frame);
  frame["transform_matrix"] = to_json(world_from_opengl(perspective.world_from_camera));
  if (keys == OwnKeys::With) frame["lumibox"] = own_keys(perspective);
  return frame;
}

/// nerfstudio reads the model at the top level alone.
const char* model_of(std::span<const Perspective> perspectives) {
  const auto fisheye = std::ranges::count_if(perspectives, [](const Perspective& p) {
    return p.camera->profile().model == config::LensModel::Fisheye;
  });
  if (fisheye != 0 && fisheye != std::ssize(perspectives)) {
    throw config::InputError(
        std::to_string(fisheye) + " of " + std::to_string(perspectives.size()) +
        " pictures are of a fisheye lens; expected all or none in one capture");
  }
  return fisheye == 0 ? "OPENCV" : "OPENCV_FISHEYE";
}

bool one_lens(std::span<const Perspective> perspectives) {
  return std::all_of(perspectives.begin(), perspectives.end(), [&](const Perspective& p) {
    return same_lens(p.camera->profile(), perspectives.front().camera->profile());
  });
}

}  // namespace

std::string picture_file(int id, const std::string& extension) {
  return std::string(kImagesFolder) + "/" + six_digits(id) + extension;
}

std::string transforms_json(std::span<const Perspective> perspectives,
                            const TransformsHeader& header, OwnKeys keys) {
  Json top{{"camera_model", model_of(perspectives)}};
  // nerfstudio looks at a frame's own intrinsics only where the top level has none.
  const bool shared_intrinsics = one_lens(perspectives);
  if (shared_intrinsics && !perspectives.empty()) {
    add_intrinsics(perspectives.front().camera->profile(), &top);
  }
  if (header.has_points) top["ply_file_path"] = kPointsFile;
  if (keys == OwnKeys::With) {
    top["lumibox"] = {{"version", 1}};
    if (header.subject) top["lumibox"]["subject"] = to_json(*header.subject);
    if (header.threshold) {
      top["lumibox"]["threshold_deg"] = *header.threshold * 180.0 / std::numbers::pi;
    }
  }

  // One line per frame: short enough to rewrite at every recording, and a person can still read it.
  std::string text = "{\n";
  for (const auto& [key, value] : top.items()) {
    text += "  " + Json(key).dump() + ": " + value.dump() + ",\n";
  }
  text += "  \"frames\": [";
  for (const Perspective& perspective : perspectives) {
    text += &perspective == perspectives.data() ? "\n    " : ",\n    ";
    text += to_json(perspective, !shared_intrinsics, keys).dump();
  }
  return text + (perspectives.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace lumibox::lightfield
