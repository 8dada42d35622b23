#include "render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "render/arrows.h"
#include "render/coverage_map.h"
#include "render/gl.h"
#include "render/shader_source.h"
#include "render/strokes.h"
#include "render/text_layout.h"

namespace lumibox::render {
namespace {

/// Describes one attribute of an interleaved vertex.
template <typename Vertex>
void attribute(GLuint location, GLint components, std::size_t offset) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                        reinterpret_cast<const void*>(offset));
}

/// A program that draws triangles given in pixels, with the buffer that they go through.
template <typename Vertex>
class Triangles {
 public:
  Triangles(std::string_view vertex_file, std::string_view fragment_file)
      : program_(gl::make_program(vertex_file, fragment_file)),
        screen_size_(gl::uniform(program_, "screen_size")),
        array_(gl::make_vertex_array()),
        buffer_(gl::make_buffer()) {
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
  }

  const gl::Program& program() const { return program_; }

  void draw(const std::vector<Vertex>& vertices, int width, int height, unsigned framebuffer) {
    if (vertices.empty()) return;
    gl::begin(framebuffer, width, height, gl::Blend::Over);
    glUseProgram(program_.name());
    glUniform2f(screen_size_, static_cast<float>(width), static_cast<float>(height));
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                 vertices.data(), GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
  }

 private:
  gl::Program program_;
  GLint screen_size_;
  gl::VertexArray array_;
  gl::Buffer buffer_;
};

Strokes reticle(int width, int height) {
  const float scale = stroke_scale(height);
  const Eigen::Vector2f middle(0.5F * static_cast<float>(width - 1),
                               0.5F * static_cast<float>(height - 1));
  Strokes strokes;
  const auto arms = [&](float half_width, const Color& color) {
    for (const Eigen::Vector2f& way : {Eigen::Vector2f(1, 0), Eigen::Vector2f(-1, 0),
                                       Eigen::Vector2f(0, 1), Eigen::Vector2f(0, -1)}) {
      const std::array<StrokePoint, 2> arm = {StrokePoint{middle + 6.0F * scale * way, 1.0F},
                                              StrokePoint{middle + 18.0F * scale * way, 1.0F}};
      strokes.line(arm, half_width * scale, color);
    }
    strokes.disc(middle, (half_width + 0.6F) * scale, color);
  };
  arms(1.9F, {0.0F, 0.0F, 0.0F, 0.5F});
  arms(0.9F, {1.0F, 1.0F, 1.0F, 0.95F});
  return strokes;
}

}  // namespace

class Overlay::Impl {
 public:
  Impl()
      : picture_program_(
            gl::make_program("screen.vert", "picture.frag", {}, shader_source("lens.glsl"))),
        no_vertices_(gl::make_vertex_array()),
        picture_(gl::make_texture(GL_TEXTURE_2D)),
        strokes_("shape.vert", "shape.frag") {
    attribute<StrokeVertex>(0, 2, offsetof(StrokeVertex, position));
    attribute<StrokeVertex>(1, 2, offsetof(StrokeVertex, across));
    attribute<StrokeVertex>(2, 1, offsetof(StrokeVertex, half_width));
    attribute<StrokeVertex>(3, 4, offsetof(StrokeVertex, color));
    text_.emplace("text.vert", "text.frag");
    attribute<TextVertex>(0, 2, offsetof(TextVertex, position));
    attribute<TextVertex>(1, 2, offsetof(TextVertex, texel));
    attribute<TextVertex>(2, 4, offsetof(TextVertex, color));
    atlas_ = gl::make_texture(GL_TEXTURE_2D);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8, Font::kAtlasSize, Font::kAtlasSize);
  }

  void draw_image(const hal::Image& color, const geometry::Camera& camera, const View& view,
                  float opacity, unsigned framebuffer) {
    if (color.empty() || color.channels() != 3) return;
    gl::begin(framebuffer, view.camera.width(), view.camera.height(),
              opacity < 1.0F ? gl::Blend::Over : gl::Blend::Replace);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, picture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, color.width(), color.height(), 0, GL_RGB,
                 GL_UNSIGNED_BYTE, color.data());
    set_picture_uniforms(camera.profile(), camera.fold_radius2(), view.camera.profile(), opacity);
    glBindVertexArray(no_vertices_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  void draw_strokes(const Strokes& strokes, int width, int height, unsigned framebuffer) {
    strokes_.draw(strokes.vertices(), width, height, framebuffer);
  }

  void draw_text(const std::vector<Text>& lines, int width, int height, unsigned framebuffer) {
    const std::vector<TextVertex> vertices = lay_out(lines, font_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, atlas_.name());
    if (atlas_revision_ != font_.revision()) {
      glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, Font::kAtlasSize, Font::kAtlasSize, GL_RED,
                      GL_UNSIGNED_BYTE, font_.atlas().data());
      atlas_revision_ = font_.revision();
    }
    glUseProgram(text_->program().name());
    glUniform2f(gl::uniform(text_->program(), "atlas_size"), Font::kAtlasSize, Font::kAtlasSize);
    text_->draw(vertices, width, height, framebuffer);
  }

 private:
  void set_picture_uniforms(const config::CameraProfile& lens, double fold_radius2,
                            const config::CameraProfile& view, float opacity) {
    const auto set = [this](const char* name, double x, double y, double z, double w) {
      glUniform4f(gl::uniform(picture_program_, name), static_cast<float>(x), static_cast<float>(y),
                  static_cast<float>(z), static_cast<float>(w));
    };
    glUseProgram(picture_program_.name());
    // gl_FragCoord is 0.5 at the first centre, with rows from below.
    set("ray_from_fragment", 1.0 / view.fx, -1.0 / view.fy, (-0.5 - view.cx) / view.fx,
        (view.height - 0.5 - view.cy) / view.fy);
    set("intrinsics", lens.fx, lens.fy, lens.cx, lens.cy);
    const bool fisheye = lens.model == config::LensModel::Fisheye;
    glUniform1i(gl::uniform(picture_program_, "fisheye"), fisheye ? 1 : 0);
    set("distortion", lens.k1, lens.k2, fisheye ? lens.k3 : lens.p1, fisheye ? lens.k4 : lens.p2);
    const auto largest = static_cast<double>(std::numeric_limits<float>::max());
    glUniform3f(gl::uniform(picture_program_, "k3_fold_opacity"), static_cast<float>(lens.k3),
                static_cast<float>(std::min(fold_radius2, largest)), opacity);
  }

  gl::Program picture_program_;
  gl::VertexArray no_vertices_;
  gl::Texture picture_;
  Triangles<StrokeVertex> strokes_;
  std::optional<Triangles<TextVertex>> text_;
  gl::Texture atlas_;
  Font font_;
  std::uint64_t atlas_revision_ = 0;
};

Overlay::Overlay() : impl_(std::make_unique<Impl>()) {}
Overlay::~Overlay() = default;

void Overlay::draw_image(const hal::Image& color, const geometry::Camera& camera, const View& view,
                         float opacity, unsigned framebuffer) {
  impl_->draw_image(color, camera, view, opacity, framebuffer);
}

void Overlay::draw_coverage(const Coverage& coverage, const View& view, unsigned framebuffer) {
  impl_->draw_strokes(coverage_map(coverage, view), view.camera.width(), view.camera.height(),
                      framebuffer);
}

void Overlay::draw_reticle(int width, int height, unsigned framebuffer) {
  impl_->draw_strokes(reticle(width, height), width, height, framebuffer);
}

void Overlay::draw_arrow(const Eigen::Vector2d& way, int width, int height, unsigned framebuffer) {
  impl_->draw_strokes(edge_arrow(way, width, height), width, height, framebuffer);
}

void Overlay::draw_text(const std::vector<Text>& lines, int width, int height,
                        unsigned framebuffer) {
  impl_->draw_text(lines, width, height, framebuffer);
}

}  // namespace lumibox::render
