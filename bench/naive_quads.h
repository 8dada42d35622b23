#pragma once

#include <map>
#include <vector>

#include "lightfield/perspective.h"
#include "render/gl.h"
#include "render/view.h"

namespace lumibox::bench {

/// The small aperture as the text of thesis 3 draws it: each of the k pictures a quad on its proxy
/// plane, one after the other from far to near, blended "over" by the GL, its border faded in the
/// texture's alpha. Blending light, the picture is that of render::Renderer, which this is here to
/// be compared with.
///
/// Preconditions: cameras without distortion, and every proxy plane wholly before the view and its
/// camera, as around a subject. All calls need the same current context.
class NaiveQuads {
 public:
  enum class Blending {
    Stored,  ///< values as they are stored, as the thesis' OpenGL did
    Light,   ///< what they stand for; needs a framebuffer in sRGB
  };
  explicit NaiveQuads(Blending blending);

  /// Draws into `framebuffer`, which has the size of view.camera. Pictures are told by their
  /// perspective's id, uploaded when first needed, and kept.
  void draw(const render::View& view, const std::vector<lightfield::Perspective>& perspectives,
            const render::Settings& settings, unsigned framebuffer);

 private:
  const render::gl::Texture& texture_of(const lightfield::Perspective& perspective,
                                        double feather_px);

  render::gl::Program program_;
  GLint clip_from_source_ = -1;
  GLint last_pixel_ = -1;
  GLint alpha_ = -1;
  render::gl::VertexArray vertex_array_;
  std::map<int, render::gl::Texture> textures_;
};

}  // namespace lumibox::bench
