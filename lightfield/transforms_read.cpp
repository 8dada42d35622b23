#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "config/error.h"
#include "geometry/position.h"
#include "hal/image_io.h"
#include "lightfield/camera_io.h"
#include "lightfield/json_value.h"
#include "lightfield/opengl_axes.h"
#include "lightfield/picture_path.h"
#include "lightfield/text_numbers.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

/// Rotations of ours are exact to rounding; those of others were often printed with few digits.
constexpr double kOwnRotationTolerance = 1e-6;
constexpr double kForeignRotationTolerance = 1e-2;

/// Far beyond any clock (146 years), and arithmetic on times cannot overflow.
constexpr long long kLatestNs = 1LL << 62;

/// A frame's member where it has one, else the file's.
std::optional<JsonValue> find(const JsonValue& frame, const JsonValue& top, const char* key) {
  if (frame.has(key)) return frame.at(key);
  if (top.has(key)) return top.at(key);
  return std::nullopt;
}

config::LensModel read_model(const JsonValue& frame, const JsonValue& top) {
  static const std::set<std::string> kPolynomial{"OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "RADIAL",
                                                 "SIMPLE_RADIAL"};
  if (const auto value = find(frame, top, "ftheta_p0"); value && value->number() != 0.0) {
    value->fail("is not zero, expected the model OPENCV or OPENCV_FISHEYE");
  }
  const auto model = find(frame, top, "camera_model");
  const bool polynomial = model && kPolynomial.contains(model->text());
  const bool fisheye = model && model->text() == "OPENCV_FISHEYE";
  if (model && !polynomial && !fisheye) {
    model->fail("is " + printable(model->text()) +
                ", expected OPENCV or a special case of it, or OPENCV_FISHEYE");
  }
  // instant-ngp says it with this key alone.
  const auto flag = find(frame, top, "is_fisheye");
  const bool flagged = flag && flag->boolean();
  if (flagged && polynomial) flag->fail("is true, expected false of a camera without fisheye lens");
  return fisheye || flagged ? config::LensModel::Fisheye : config::LensModel::Opencv;
}

/// Intrinsics of a frame; `picture` gives the size where the file does not.
config::CameraProfile read_lens(const JsonValue& frame, const JsonValue& top,
                                const fs::path& picture) {
  const auto number = [&](const char* key, double fallback) {
    const auto value = find(frame, top, key);
    return value ? value->number() : fallback;
  };
  config::CameraProfile c;
  c.model = read_model(frame, top);
  const auto width = find(frame, top, "w");
  const auto height = find(frame, top, "h");
  if (width && height) {
    constexpr long long kLargest = 1 << 30;  // refused below, but fits an int
    c.width = static_cast<int>(width->integer(0, kLargest));
    c.height = static_cast<int>(height->integer(0, kLargest));
  } else {
    const hal::ImageInfo info = hal::read_image_info(picture);
    c.width = info.width;
    c.height = info.height;
  }
  using Length = std::optional<double>;
  const auto focal = [&](const char* length_key, const char* angle_key, int side) -> Length {
    if (const auto length = find(frame, top, length_key)) return length->number();
    if (const auto angle = find(frame, top, angle_key)) {
      return 0.5 * side / std::tan(0.5 * angle->number());
    }
    return std::nullopt;
  };
  const Length fx = focal("fl_x", "camera_angle_x", c.width);
  const Length fy = focal("fl_y", "camera_angle_y", c.height);
  if (!fx && !fy) frame.fail("has neither fl_x nor camera_angle_x");
  c.fx = fx ? *fx : *fy;
  c.fy = fy ? *fy : *fx;
  c.cx = number("cx", 0.5 * c.width);
  c.cy = number("cy", 0.5 * c.height);
  c.k1 = number("k1", 0.0);
  c.k2 = number("k2", 0.0);
  c.p1 = number("p1", 0.0);
  c.p2 = number("p2", 0.0);
  c.k3 = number("k3", 0.0);
  c.k4 = number("k4", 0.0);
  // Before the move of the principal point, so that the words have the file's own numbers.
  if (const auto fault = config::fault_of(c)) frame.fail("has a camera whose " + *fault);
  c.cx -= kForeignPixelCentre;
  c.cy -= kForeignPixelCentre;
  return c;
}

Eigen::Vector3d checked_position(const Eigen::Vector3d& position, const JsonValue& value) {
  if (const auto fault = geometry::fault_of_position(position)) value.fail("has " + *fault);
  return position;
}

geometry::Pose read_matrix(const JsonValue& value, double tolerance) {
  const std::vector<JsonValue> rows = value.items();
  if (rows.size() != 3 && rows.size() != 4) {
    value.fail("has " + std::to_string(rows.size()) + " rows, expected 4");
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    matrix.row(static_cast<Eigen::Index>(r)) = rows[r].numbers(4).transpose();
  }
  const auto pose = pose_from_opengl(matrix, tolerance);
  if (!pose) value.fail("is not a rotation and a translation, expected camera to world");
  checked_position(pose->translation, value);
  return *pose;
}

/// Of perspectives and keyframes.
constexpr long long kLargestId = 1LL << 30;

/// The members under "lumibox" of a frame.
void read_own_keys(const JsonValue& own, Perspective* perspective) {
  perspective->id = static_cast<int>(own.at("id").integer(0, kLargestId));
  perspective->timestamp_ns = own.at("timestamp_ns").integer(-kLatestNs, kLatestNs);
  if (!own.has("keyframe")) return;
  perspective->keyframe = static_cast<int>(own.at("keyframe").integer(0, kLargestId));
  const JsonValue pose = own.at("keyframe_from_camera");
  const Eigen::VectorXd q = pose.at("rotation_wxyz").numbers(4);
  if (std::abs(q.norm() - 1.0) > kOwnRotationTolerance) {
    pose.at("rotation_wxyz").fail("is not a unit quaternion");
  }
  perspective->keyframe_from_camera =
      geometry::Pose(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized(),
                     checked_position(pose.at("translation").numbers(3), pose.at("translation")));
}

Sphere read_sphere(const JsonValue& subject) {
  Sphere sphere;
  sphere.center = checked_position(subject.at("center").numbers(3), subject.at("center"));
  sphere.radius = subject.at("radius").number();
  if (!(sphere.radius > 0.0 && sphere.radius <= geometry::kLargestCoordinate)) {
    subject.at("radius").fail("is " + to_text(sphere.radius) + ", expected more than 0, up to 1e9");
  }
  if (subject.has("keyframe")) {
    const JsonValue center = subject.at("center_in_keyframe");
    sphere.keyframe = static_cast<int>(subject.at("keyframe").integer(0, kLargestId));
    sphere.center_in_keyframe = checked_position(center.numbers(3), center);
  }
  return sphere;
}

double read_threshold(const JsonValue& value) {
  const double degrees = value.number();
  if (!(degrees > 0.0 && degrees <= 180.0)) {
    value.fail("is " + to_text(degrees) + ", expected more than 0, up to 180");
  }
  return degrees * std::numbers::pi / 180.0;
}

/// The text at `value`, a path of a file in the same folder or below.
std::string read_path(const JsonValue& value) {
  std::string path = value.text();
  if (!stays_inside(path)) {
    value.fail("is \"" + printable(path) + "\", expected a path inside the folder");
  }
  return path;
}

/// instant-ngp's own data sets leave out the extension.
std::string with_extension(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (fs::is_regular_file(folder / name, error)) return name;
  for (const char* extension : {".png", ".jpg", ".jpeg", ".PNG", ".JPG"}) {
    if (fs::is_regular_file(folder / (name + extension), error)) return name + extension;
  }
  return name;
}

std::vector<std::string> read_picture_names(const std::vector<JsonValue>& frames,
                                            const fs::path& file, Dialect dialect) {
  const fs::path folder = file.parent_path();
  std::vector<std::string> names;
  std::map<fs::path, std::size_t> frame_of;
  for (const JsonValue& frame : frames) {
    const JsonValue path = frame.at("file_path");
    names.push_back(read_path(path));
    if (dialect == Dialect::Foreign) names.back() = with_extension(folder, names.back());
    const fs::path picture = fs::path(names.back()).lexically_normal();
    const auto [earlier, is_new] = frame_of.emplace(picture, frame_of.size());
    if (is_new) continue;
    path.fail("names " + printable(picture.string()) + ", as does frames[" +
              std::to_string(earlier->second) + "].file_path; expected a picture for each frame");
  }
  require_pictures(file, folder, names);
  return names;
}

std::int64_t read_foreign_time(const JsonValue& frame) {
  const double ns = frame.number_or("timestamp", 0.0) * 1e9;
  if (std::abs(ns) > static_cast<double>(kLatestNs)) frame.fail("has a timestamp out of range");
  return std::llround(ns);
}

}  // namespace

Transforms read_transforms(const fs::path& file, Dialect dialect) {
  const JsonFile json(file);
  const JsonValue top = json.root();
  const bool own = dialect == Dialect::Capture;
  if (own && !top.has("lumibox")) {
    throw config::InputError(file,
                             "has no \"lumibox\" member, expected a capture: make one of other "
                             "data sets with `lumibox import`");
  }
  Transforms transforms;
  if (top.has("lumibox")) {
    const JsonValue keys = top.at("lumibox");
    keys.at("version").integer(1, 1);
    if (keys.has("subject")) transforms.subject = read_sphere(keys.at("subject"));
    if (keys.has("threshold_deg")) transforms.threshold = read_threshold(keys.at("threshold_deg"));
  }
  if (top.has("ply_file_path")) {
    transforms.points_file = read_path(top.at("ply_file_path"));
  }

  CameraPool cameras;
  std::set<int> ids;
  const std::vector<JsonValue> frames = top.at("frames").items();
  const std::vector<std::string> pictures = read_picture_names(frames, file, dialect);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const JsonValue& frame = frames[i];
    Perspective perspective;
    perspective.id = static_cast<int>(i);
    perspective.file = pictures[i];
    if (own) {
      read_own_keys(frame.at("lumibox"), &perspective);
    } else {
      perspective.timestamp_ns = read_foreign_time(frame);
    }
    perspective.camera = cameras.get(read_lens(frame, top, file.parent_path() / perspective.file));
    perspective.world_from_camera = read_matrix(
        frame.at("transform_matrix"), own ? kOwnRotationTolerance : kForeignRotationTolerance);
    if (!ids.insert(perspective.id).second) frame.fail("has the id of an earlier frame");
    transforms.perspectives.push_back(std::move(perspective));
  }
  return transforms;
}

}  // namespace lumibox::lightfield
