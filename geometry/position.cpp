#include "geometry/position.h"

#include <cmath>
#include <sstream>

namespace lumibox::geometry {

std::optional<std::string> fault_of_position(const Eigen::Vector3d& position) {
  for (const double coordinate : position) {
    if (!(std::abs(coordinate) <= kLargestCoordinate)) {  // NaN included
      std::ostringstream message;
      message << "a coordinate of " << coordinate << "; expected " << -kLargestCoordinate << " to "
              << kLargestCoordinate;
      return message.str();
    }
  }
  return std::nullopt;
}

}  // namespace lumibox::geometry
