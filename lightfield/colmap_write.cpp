#include <initializer_list>
#include <map>
#include <string_view>

#include "geometry/rotation.h"
#include "lightfield/camera_io.h"
#include "lightfield/colmap.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {
namespace {

/// A line of a model file: words with one blank between them.
class Line {
 public:
  explicit Line(std::size_t id) : text_(std::to_string(id)) {}

  Line& add(std::string_view word) {
    text_ += ' ';
    text_ += word;
    return *this;
  }
  Line& add(std::initializer_list<double> numbers) {
    for (const double number : numbers) add(to_text(number));
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string camera_line(std::size_t id, const config::CameraProfile& c) {
  Line line(id);
  const bool fisheye = c.model == config::LensModel::Fisheye;
  // OPENCV has no k3; FULL_OPENCV has, and three more.
  const bool full = !fisheye && c.k3 != 0.0;
  line.add(fisheye ? "OPENCV_FISHEYE"
           : full  ? "FULL_OPENCV"
                   : "OPENCV")
      .add(std::to_string(c.width))
      .add(std::to_string(c.height))
      .add({c.fx, c.fy, c.cx + kForeignPixelCentre, c.cy + kForeignPixelCentre})
      .add({c.k1, c.k2, fisheye ? c.k3 : c.p1, fisheye ? c.k4 : c.p2});
  if (full) line.add({c.k3, 0.0, 0.0, 0.0});
  return line.text() + "\n";
}

std::string image_line(std::size_t id, const Perspective& perspective, std::size_t camera_id) {
  const geometry::Pose pose = perspective.world_from_camera.inverse();
  const Eigen::Quaterniond q = geometry::canonical(pose.rotation);
  const Eigen::Vector3d& t = pose.translation;
  // COLMAP's names are relative to the folder of the pictures.
  const std::string name = std::filesystem::path(perspective.file).filename().string();
  return Line(id)
             .add({q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()})
             .add(std::to_string(camera_id))
             .add(name)
             .text() +
         "\n\n";
}

}  // namespace

void write_colmap(const std::vector<Perspective>& perspectives,
                  const std::vector<Eigen::Vector3d>& points, const std::filesystem::path& folder,
                  const DurableFiles& files) {
  std::string cameras_txt = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
  std::string images_txt =
      "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of POINTS2D[]\n";
  std::string points_txt = "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n";

  CameraPool pool;
  std::map<const geometry::Camera*, std::size_t> camera_ids;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    const auto camera = pool.get(perspectives[i].camera->profile());
    const auto [entry, is_new] = camera_ids.emplace(camera.get(), camera_ids.size() + 1);
    if (is_new) cameras_txt += camera_line(entry->second, camera->profile());
    images_txt += image_line(i + 1, perspectives[i], entry->second);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The map keeps no colours, so grey.
    points_txt +=
        Line(i + 1).add({points[i].x(), points[i].y(), points[i].z()}).add("128 128 128 0").text();
    points_txt += "\n";
  }
  files.write(folder / "cameras.txt", cameras_txt);
  files.write(folder / "points3D.txt", points_txt);
  files.write(folder / "images.txt", images_txt);
}

}  // namespace lumibox::lightfield
