#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "config/error.h"
#include "geometry/rotation.h"
#include "lightfield/capture.h"
#include "support/photo.h"

namespace lumibox::lightfield {

/// A fresh folder that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lumibox-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// Message of the InputError that `action` throws; empty if it throws none.
inline std::string input_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const config::InputError& error) {
    return error.what();
  }
  return "";
}

inline std::shared_ptr<const geometry::Camera> small_camera(double k3 = 0.0) {
  config::CameraProfile profile;
  profile.width = 16;
  profile.height = 12;
  profile.fx = 20.1;
  profile.fy = 20.3;
  profile.cx = 7.4;
  profile.cy = 5.6;
  profile.k1 = 0.05;
  profile.k2 = -0.01;
  profile.p1 = 0.001;
  profile.p2 = -0.002;
  profile.k3 = k3;
  return std::make_shared<const geometry::Camera>(profile);
}

inline std::shared_ptr<const geometry::Camera> small_fisheye_camera() {
  config::CameraProfile profile = small_camera(0.003)->profile();
  profile.model = config::LensModel::Fisheye;
  profile.p1 = profile.p2 = 0.0;
  profile.k4 = -0.004;
  return std::make_shared<const geometry::Camera>(profile);
}

/// A camera on a spiral around `subject` at distance 2, looking at it.
inline geometry::Pose orbit_pose(int i, const Eigen::Vector3d& subject) {
  const double angle = 0.3 * i;
  const Eigen::Vector3d from_subject(std::sin(angle), 0.2 * std::sin(0.7 * i), -std::cos(angle));
  const Eigen::Vector3d forward = -from_subject.normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(forward).normalized();
  Eigen::Matrix3d rotation;
  rotation << right, forward.cross(right), forward;
  return {rotation, subject - 2.0 * forward};
}

inline Perspective make_perspective(int i, const Eigen::Vector3d& subject,
                                    std::shared_ptr<const geometry::Camera> camera) {
  hal::Image image(camera->width(), camera->height(), 3);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      image.at(x, y)[0] = static_cast<std::uint8_t>(10 * x);
      image.at(x, y)[1] = static_cast<std::uint8_t>(10 * y);
      image.at(x, y)[2] = static_cast<std::uint8_t>(7 * i);
    }
  }
  Perspective perspective;
  perspective.id = i;
  perspective.world_from_camera = orbit_pose(i, subject);
  perspective.timestamp_ns = 1305031102175304123LL + i * 33333333LL;
  perspective.photo = testing::photo_of(std::move(image));
  perspective.camera = std::move(camera);
  perspective.keyframe = i / 3;
  perspective.keyframe_from_camera = geometry::Pose(
      geometry::exp_so3(Eigen::Vector3d(0.1, 0.02 * i, -0.3)), Eigen::Vector3d(0.1, 0.2, 0.3 * i));
  return perspective;
}

/// A capture in memory of `count` perspectives around (0.1, -0.2, 3), with points.
inline Capture make_capture(int count) {
  const Sphere sphere{Eigen::Vector3d(0.1, -0.2, 3.0), 0.7};
  Capture capture;
  capture.light_field.set_subject(sphere);
  for (int i = 0; i < count; ++i) {
    capture.light_field.add(make_perspective(i, sphere.center, small_camera()));
    capture.points.push_back(sphere.center + 0.1 * Eigen::Vector3d(i, -i, 1.0 / 3.0));
  }
  return capture;
}

/// Largest difference of centres and rotation matrices.
inline double pose_difference(const LightField& a, const LightField& b) {
  if (a.perspectives().size() != b.perspectives().size()) return INFINITY;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.perspectives().size(); ++i) {
    largest = std::max(largest, (a.perspectives()[i].world_from_camera.matrix4() -
                                 b.perspectives()[i].world_from_camera.matrix4())
                                    .cwiseAbs()
                                    .maxCoeff());
  }
  return largest;
}

}  // namespace lumibox::lightfield
