#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// How far a long work has come.
using ProgressReport = std::function<void(std::int64_t done, std::int64_t total)>;

/// Points in world on what the perspectives show, found in their pictures by their poses and
/// lenses: features, matched along epipolar lines between neighbours, joined to tracks, and
/// triangulated with all views of a track. Only points that three views or more agree on and whose
/// distance is well known. Empty where nothing can be found: fewer than three pictures, no texture,
/// no parallax. Time and memory grow linearly with the number of pictures, and not with their size;
/// two calls give the same points to the bit. Precondition: every perspective has its picture.
std::vector<Eigen::Vector3d> find_scene_points(const std::vector<Perspective>& perspectives,
                                               const ProgressReport& progress = {});

}  // namespace lumibox::lightfield
