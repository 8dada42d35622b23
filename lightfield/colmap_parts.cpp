#include "lightfield/colmap_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/position.h"
#include "lightfield/camera_io.h"

namespace lumibox::lightfield {
namespace {

constexpr std::array<ColmapLens, 7> kLenses{{{0, "SIMPLE_PINHOLE", 3},
                                             {1, "PINHOLE", 4},
                                             {2, "SIMPLE_RADIAL", 4},
                                             {3, "RADIAL", 5},
                                             {4, "OPENCV", 8},
                                             {5, "OPENCV_FISHEYE", 8},
                                             {6, "FULL_OPENCV", 12}}};

template <typename Predicate>
const ColmapLens* find_if(Predicate predicate) {
  const auto found = std::find_if(kLenses.begin(), kLenses.end(), predicate);
  return found == kLenses.end() ? nullptr : &*found;
}

}  // namespace

const ColmapLens* find_lens(std::string_view name) {
  return find_if([name](const ColmapLens& lens) { return lens.name == name; });
}

const ColmapLens* find_lens(int id) {
  return find_if([id](const ColmapLens& lens) { return lens.id == id; });
}

std::string foreign_lens_name(int id) {
  switch (id) {
    case 7:
      return "FOV";
    case 8:
      return "SIMPLE_RADIAL_FISHEYE";
    case 9:
      return "RADIAL_FISHEYE";
    case 10:
      return "THIN_PRISM_FISHEYE";
    default:
      return "number " + std::to_string(id);
  }
}

config::CameraProfile to_profile(const ColmapLens& lens, std::int64_t width, std::int64_t height,
                                 std::span<const double> p, std::string* flaw) {
  constexpr std::int64_t kLargest = 1 << 30;  // refused below, but fits an int
  config::CameraProfile c;
  c.width = static_cast<int>(std::clamp<std::int64_t>(width, 0, kLargest));
  c.height = static_cast<int>(std::clamp<std::int64_t>(height, 0, kLargest));
  const bool one_focal_length = lens.name.starts_with("SIMPLE_") || lens.name == "RADIAL";
  std::size_t next = 0;
  c.fx = p[next++];
  c.fy = one_focal_length ? c.fx : p[next++];
  c.cx = p[next++];
  c.cy = p[next++];
  const bool fisheye = lens.name == "OPENCV_FISHEYE";
  if (fisheye) c.model = config::LensModel::Fisheye;
  double* const third = fisheye ? &c.k3 : &c.p1;
  double* const fourth = fisheye ? &c.k4 : &c.p2;
  for (double* coefficient : {&c.k1, &c.k2, third, fourth, &c.k3}) {
    if (next < lens.parameters) *coefficient = p[next++];
  }
  *flaw = config::fault_of(c).value_or("");  // in the file's own numbers
  c.cx -= kForeignPixelCentre;
  c.cy -= kForeignPixelCentre;
  for (; next < lens.parameters; ++next) {
    if (p[next] != 0.0) *flaw = "k4, k5 or k6 is not zero; expected a polynomial distortion";
  }
  return c;
}

geometry::Pose to_pose(std::span<const double, 7> v, std::string* flaw) {
  const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
  const Eigen::Vector3d translation(v[4], v[5], v[6]);
  *flaw = geometry::fault_of_position(translation).value_or("");
  // COLMAP normalises what it reads; a quaternion far from unit was not meant as one.
  if (!(std::abs(q.norm() - 1.0) <= 1e-2)) *flaw = "a rotation that is not a unit quaternion";
  return flaw->empty() ? geometry::Pose(q.normalized(), translation) : geometry::Pose();
}

}  // namespace lumibox::lightfield
