#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/config.h"
#include "hal/image.h"
#include "lightfield/perspective.h"
#include "render/proxy_geometry.h"
#include "render/view.h"

namespace lumibox::render {

/// How like the photograph a picture is; NaN where there was nothing to compare.
struct Quality {
  double psnr = 0.0;          ///< dB
  double ssim = 0.0;          ///< 0..1
  double psnr_subject = 0.0;  ///< inside the sphere's outline
  double ssim_subject = 0.0;
};

struct ViewQuality {
  int perspective_id = 0;
  std::string file;  ///< of the perspective
  Quality quality;
};

/// A way to reconstruct a view.
struct Method {
  std::string name;
  Settings settings;
  Geometry geometry = Geometry::Plane;
};

/// What is compared: `nearest`, the nearest picture alone on its plane; `plane-small` and
/// `plane-wide`, the apertures as the person sees them; `plane-sharp`, the wide aperture with so
/// high an exponent that only the nearest few count (thesis 3.2: a large depth of field); `focal`
/// and `mesh`, the small aperture on those (see Geometry).
std::vector<Method> compared_methods(const config::Render& options, const Eigen::Vector3d& focus);

struct MethodQuality {
  std::string method;
  Quality mean;  ///< over the views that had something to compare
  std::vector<ViewQuality> views;
};

/// The renderer to be judged: the GL one or the reference.
using RenderView = std::function<hal::Image(
    const View&, const std::vector<lightfield::Perspective>&, const Method&)>;

/// A perspective's picture without its lens's distortion, at the same focal length and size. Throws
/// config::InputError if the picture is lost.
struct UndistortedPicture {
  hal::Image color;  ///< three channels
  hal::Image valid;  ///< one channel: 255 where the photograph has the pixel
};
UndistortedPicture undistort(const lightfield::Perspective& perspective);

/// What a view of a perspective is measured against.
struct Photograph {
  View view;  ///< the perspective's own, without its lens's distortion
  UndistortedPicture picture;
  hal::Image on_subject;  ///< 255 where the picture has pixels within the sphere's outline
};
Photograph photograph_of(const lightfield::Perspective& perspective,
                         const lightfield::Sphere& subject);

/// Of a picture of the photograph's view.
Quality quality_of(const hal::Image& picture, const Photograph& photograph);

/// For each perspective in turn: its view rendered from all others, compared with its own
/// undistorted photograph wherever that has pixels. Pixels that no other perspective covers stay
/// black and count in full: that is what the person would see. `each_view`, if set, is called
/// before each view with its index.
std::vector<MethodQuality> leave_one_out(const std::vector<lightfield::Perspective>& perspectives,
                                         const lightfield::Sphere& subject,
                                         const config::Render& options, const RenderView& render,
                                         const std::function<void(std::size_t)>& each_view = {});

}  // namespace lumibox::render
