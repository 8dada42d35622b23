#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

inline constexpr const char* kTransformsFile = "transforms.json";
inline constexpr const char* kPointsFile = "points.ply";
inline constexpr const char* kImagesFolder = "images";

/// "images/000012.jpg": where a capture keeps the picture of a perspective. `extension` has its
/// dot.
std::string picture_file(int id, const std::string& extension = ".jpg");

/// Whether the box's own keys, which other programs ignore, are written too.
enum class OwnKeys { With, Without };

/// What a transforms.json says besides its perspectives.
struct TransformsHeader {
  std::optional<Sphere> subject;
  std::optional<double> threshold;  ///< of the gate, radians
  bool has_points = false;
};

/// Text of a transforms.json as nerfstudio wants it (docs/capture-format.md). Only pose, camera,
/// file, timestamp, id and keyframe of the perspectives are used.
std::string transforms_json(std::span<const Perspective> perspectives,
                            const TransformsHeader& header, OwnKeys keys);

/// What a transforms.json says; pictures not read yet, perspectives without `color`.
struct Transforms {
  std::vector<Perspective> perspectives;
  std::optional<Sphere> subject;
  std::optional<double> threshold;  ///< of the gate, radians
  std::optional<std::string> points_file;
};

/// How much a reader asks for.
enum class Dialect {
  Capture,  ///< written by us: our keys must be there
  Foreign,  ///< nerfstudio or instant-ngp: intrinsics in their several forms, names without
            ///< extension, rotations good to a few digits; frames get ids in their order
};

/// Reads a transforms.json. Throws config::InputError.
Transforms read_transforms(const std::filesystem::path& file, Dialect dialect);

}  // namespace lumibox::lightfield
