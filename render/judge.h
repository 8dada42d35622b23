#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "config/config.h"
#include "lightfield/perspective.h"
#include "render/leave_one_out.h"
#include "render/proxy_geometry.h"

namespace lumibox::render {

/// Pixels of a picture that is judged: 640x480 becomes 80x60. Small enough to be judged while
/// others are recorded; a pose that is off by a degree shows as a shift of more than a pixel.
inline constexpr int kThumbnail = 9000;

/// How a perspective's picture differs, on the subject, from what others say its view looks like;
/// NaN where there was nothing to compare. What nobody else covers counts for the PSNR alone.
struct Judgement {
  double psnr = std::numeric_limits<double>::quiet_NaN();  ///< dB
  /// By which angle it lies beside where the others have it, radians: a wrong pose.
  double shift = std::numeric_limits<double>::quiet_NaN();
  /// patch_difference(), grey levels: an occluder, another exposure.
  double difference = std::numeric_limits<double>::quiet_NaN();
};

/// The perspectives that one is judged by.
struct Jury {
  std::vector<std::size_t> members;  ///< indices: the nearest by angle at S, nearest first
  double nearest = 0.0;              ///< angle at S to the first, radians
};
Jury jury_of(const std::vector<lightfield::Perspective>& perspectives, std::size_t index,
             const Eigen::Vector3d& subject);

/// Judges perspectives as leave_one_out() does, at the size of thumbnails and with the reference
/// renderer: no GPU is needed, and any thread may have one. Not thread safe.
class Judge {
 public:
  explicit Judge(const config::Render& options);

  /// The view of `perspectives[index]` as the small aperture shows it from the jury alone, against
  /// its own picture. Perspectives are reduced(…, kThumbnail).
  Judgement judge(const std::vector<lightfield::Perspective>& perspectives, std::size_t index,
                  const std::vector<std::size_t>& jury, const lightfield::Sphere& subject);

  /// The same by every other member of the jury, and by the rest: of each figure the better one.
  /// What is bad in one picture is in one half of the jury alone, and so does not tell against
  /// those around it.
  Judgement appeal(const std::vector<lightfield::Perspective>& perspectives, std::size_t index,
                   const std::vector<std::size_t>& jury, const lightfield::Sphere& subject);

 private:
  Settings settings_;
  Geometry geometry_;
  ProxyGeometry proxy_;
};

}  // namespace lumibox::render
