#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::render {

/// How much brighter one picture is than another where both show the same.
struct LightRatio {
  std::size_t first = 0;
  std::size_t second = 0;   ///< indices of perspectives
  double log_ratio = 0.0;   ///< ln(light of the second / light of the first)
  double deviation = 0.01;  ///< standard deviation of that; positive
};

/// Gains that make `count` pictures as bright as each other: the least squares of Brown and Lowe,
/// "Automatic Panoramic Image Stitching using Invariant Features", IJCV 74(1), 2007, section 6, in
/// logarithms, where it is linear, and with Huber's weights, so that one bad picture does not spoil
/// its neighbours. A prior holds each gain to 1, so the geometric mean is about 1. Bounded; 1 for
/// pictures without a ratio.
std::vector<double> gains_from(std::size_t count, const std::vector<LightRatio>& ratios);

/// A light field whose pictures were taken with different exposures flickers as the view moves.
/// Finds the gains that make neighbours equally bright (Perspective::gain). Remembers the light of
/// the pictures it has seen. Not thread safe.
class Exposure {
 public:
  /// One gain per perspective. Neighbours by angle at `focus` (S) are compared at those of the
  /// scene's points that both show. The perspectives' own gains mean nothing here. 1 where nothing
  /// can be compared: no points, no overlap, no picture, nothing but black or white.
  std::vector<double> gains(const std::vector<lightfield::Perspective>& perspectives,
                            const Eigen::Vector3d& focus,
                            const std::vector<Eigen::Vector3d>& points);

 private:
  /// A small picture's luma as light; NaN where it is too dark or too bright to tell.
  struct LightPicture {
    std::weak_ptr<const lightfield::Photo> photo;
    std::shared_ptr<const geometry::Camera> camera;  ///< of the small picture
    std::vector<float> light;                        ///< row by row
  };

  const LightPicture* picture_of(const lightfield::Perspective& perspective);
  static LightPicture make_picture(const lightfield::Perspective& perspective);

  std::map<const lightfield::Photo*, LightPicture> pictures_;
};

/// Gains by id that follow those found: where one changes while the light field is looked at,
/// nothing jumps.
class EasedGains {
 public:
  /// Once per tick: goes a share of the way, in logarithms. An id that is new comes from 1; one
  /// that is no longer there is forgotten.
  const std::map<int, double>& step(const std::map<int, double>& found);

 private:
  std::map<int, double> gains_;
};

}  // namespace lumibox::render
