#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace lumibox::lightfield {

/// Points as a PLY file: binary, little endian, properties x y z as doubles, nothing lost.
std::vector<std::uint8_t> encode_ply(const std::vector<Eigen::Vector3d>& points);

/// Vertex positions of a PLY file, ASCII or binary little endian; its `vertex` element must come
/// first and hold x, y and z, other properties are skipped. Throws config::InputError.
std::vector<Eigen::Vector3d> read_ply(const std::filesystem::path& path);

}  // namespace lumibox::lightfield
