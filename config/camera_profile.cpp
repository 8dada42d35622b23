#include "config/camera_profile.h"

#include <algorithm>
#include <sstream>

namespace lumibox::config {
namespace {

struct Quantity {
  const char* name;
  double value;
  double min;
  double max;
};

/// A coefficient that the model does not have would be ignored by those who use the profile.
std::optional<std::string> foreign_coefficient(const CameraProfile& c) {
  const bool fisheye = c.model == LensModel::Fisheye;
  std::ostringstream message;
  if (fisheye && c.p1 != 0.0) message << "p1 is " << c.p1;
  if (fisheye && c.p1 == 0.0 && c.p2 != 0.0) message << "p2 is " << c.p2;
  if (!fisheye && c.k4 != 0.0) message << "k4 is " << c.k4;
  if (message.str().empty()) return std::nullopt;
  message << "; expected 0 of a lens of the model \"" << name_of(c.model) << '"';
  return message.str();
}

}  // namespace

const char* name_of(LensModel model) {
  return model == LensModel::Fisheye ? "fisheye" : "opencv";
}

std::optional<std::string> fault_of(const CameraProfile& profile) {
  const double width = profile.width;
  const double height = profile.height;
  const double side = std::max(width, height);
  const Quantity quantities[] = {
      {"width", width, 8, 16384},
      {"height", height, 8, 16384},
      {"fx", profile.fx, side / 100, side * 100},
      {"fy", profile.fy, side / 100, side * 100},
      {"cx", profile.cx, -width / 2, width * 1.5},
      {"cy", profile.cy, -height / 2, height * 1.5},
      {"k1", profile.k1, -100, 100},
      {"k2", profile.k2, -100, 100},
      {"p1", profile.p1, -100, 100},
      {"p2", profile.p2, -100, 100},
      {"k3", profile.k3, -100, 100},
      {"k4", profile.k4, -100, 100},
      {"fps", profile.fps, 0.01, 1000},
      {"readout_s", profile.readout_s, 0, 1},
  };
  for (const Quantity& q : quantities) {
    if (!(q.value >= q.min && q.value <= q.max)) {  // NaN included
      std::ostringstream message;
      message << q.name << " is " << q.value << "; expected " << q.min << " to " << q.max;
      return message.str();
    }
  }
  return foreign_coefficient(profile);
}

}  // namespace lumibox::config
