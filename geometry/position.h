#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace lumibox::geometry {

/// Largest coordinate, and largest radius, that a file may give: in metres beyond the moon, and its
/// fourth power still has all digits of a double.
inline constexpr double kLargestCoordinate = 1e9;

/// What is implausible about a position that a file gives, in words that name the number and its
/// range; none if one can compute with it.
std::optional<std::string> fault_of_position(const Eigen::Vector3d& position);

}  // namespace lumibox::geometry
