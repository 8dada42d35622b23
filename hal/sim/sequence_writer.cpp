#include <Eigen/Geometry>
#include <fstream>
#include <iomanip>
#include <string>
#include <system_error>

#include "config/error.h"
#include "geometry/rotation.h"
#include "hal/image_io.h"
#include "hal/new_folder.h"
#include "hal/sim/frame_renderer.h"
#include "hal/sim/scene.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;

void make_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "rgb", error);
  if (error) throw config::InputError(folder, "cannot make this folder: " + error.message());
}

/// A text file that holds whole lines at every instant, whoever stops the program.
class TextFile {
 public:
  explicit TextFile(fs::path path) : path_(std::move(path)), stream_(path_) { check(); }

  std::ostream& line() { return stream_; }

  void end_line() {
    stream_ << '\n' << std::flush;
    check();
  }

  void close() {
    stream_.close();
    check();
  }

 private:
  void check() const {
    if (!stream_) throw config::InputError(path_, "cannot be written");
  }

  fs::path path_;
  std::ofstream stream_;
};

void write_calibration(const config::CameraProfile& camera, const fs::path& path) {
  TextFile file(path);
  file.line() << "# fx fy cx cy k1 k2 p1 p2 width height fps k3 readout_s\n"
              << std::setprecision(12) << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' '
              << camera.cy << ' ' << camera.k1 << ' ' << camera.k2 << ' ' << camera.p1 << ' '
              << camera.p2 << ' ' << camera.width << ' ' << camera.height << ' ' << camera.fps
              << ' ' << camera.k3 << ' ' << camera.readout_s << '\n';
  file.close();
}

void write_subject(const Scene::Subject& subject, const fs::path& path) {
  TextFile file(path);
  file.line() << "# x y z radius\n"
              << std::setprecision(12) << subject.center.x() << ' ' << subject.center.y() << ' '
              << subject.center.z() << ' ' << subject.radius << '\n';
  file.close();
}

std::string image_name(std::int64_t frame) {
  std::string digits = std::to_string(frame);
  digits.insert(0, digits.size() < 6 ? 6 - digits.size() : 0, '0');
  return "rgb/" + digits + ".png";
}

void write_pose(std::ostream& out, const geometry::Pose& world_from_camera) {
  const Eigen::Vector3d& t = world_from_camera.translation;
  const Eigen::Quaterniond q = geometry::canonical(world_from_camera.rotation);
  out << std::setprecision(12) << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x()
      << ' ' << q.y() << ' ' << q.z() << ' ' << q.w();
}

/// Seconds with all nine digits, exactly.
std::string seconds(std::int64_t ns) {
  std::string fraction = std::to_string(ns % 1'000'000'000);
  fraction.insert(0, 9 - fraction.size(), '0');
  return std::to_string(ns / 1'000'000'000) + "." + fraction;
}

}  // namespace

void write_sequence(const Scene& scene, const fs::path& folder,
                    const std::function<void(std::int64_t, std::int64_t)>& progress) {
  require_new_folder(folder);
  make_folders(folder);
  write_calibration(scene.profile(), folder / "calib.txt");
  write_subject(scene.subject(), folder / "subject.txt");
  TextFile list(folder / "rgb.txt");
  TextFile truth(folder / "groundtruth.txt");
  list.line() << "# timestamp file\n";
  truth.line()
      << "# timestamp tx ty tz qx qy qz qw (world from camera; x right, y down, z forward)\n";

  sim::FrameRenderer renderer(scene);
  SimCost cost;
  const std::int64_t total = scene.frame_count();
  for (std::int64_t frame = 0; frame < total; ++frame) {
    if (!sim::is_dropped(scene.impl().spec.effects, frame)) {
      const std::string stamp = seconds(scene.timestamp_ns(frame));
      write_png(folder / image_name(frame), renderer.render(frame, false, cost));
      truth.line() << stamp;
      write_pose(truth.line(),
                 scene.world_from_camera(static_cast<double>(scene.timestamp_ns(frame)) * 1e-9));
      truth.end_line();
      // Last, since a picture that is listed must be whole.
      list.line() << stamp << ' ' << image_name(frame);
      list.end_line();
    }
    if (progress) progress(frame + 1, total);
  }
  list.close();
  truth.close();
}

}  // namespace lumibox::hal
