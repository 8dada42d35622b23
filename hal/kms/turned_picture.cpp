#include "hal/kms/turned_picture.h"

#include <GLES3/gl3.h>

#include <string>
#include <utility>
#include <vector>

#include "config/error.h"

namespace lumibox::hal::kms {
namespace {

// One triangle that covers the panel's part; no vertex data.
constexpr const char* kVertexShader = R"(#version 300 es
uniform mat2 picture_from_panel;
out vec2 place;
void main() {
  vec2 corner = vec2(float((gl_VertexID & 1) * 4 - 1), float((gl_VertexID & 2) * 2 - 1));
  place = 0.5 * (picture_from_panel * corner) + 0.5;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";
constexpr const char* kFragmentShader = R"(#version 300 es
precision highp float;
uniform highp sampler2D picture;
in vec2 place;
out vec4 color;
void main() {
  color = vec4(texture(picture, place).rgb, 1.0);
}
)";

void attach(GLuint program, GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader);  // with the program
}

GLuint make_program() {
  const GLuint program = glCreateProgram();
  attach(program, GL_VERTEX_SHADER, kVertexShader);
  attach(program, GL_FRAGMENT_SHADER, kFragmentShader);
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == 0) {
    std::string log(1024, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw config::InputError("display: the driver cannot turn pictures: " + log);
  }
  return program;
}

/// Switches off what would keep a triangle from covering its part, and on again at the end.
class PlainDrawing {
 public:
  PlainDrawing() {
    for (const GLenum state :
         {GL_BLEND, GL_SCISSOR_TEST, GL_DEPTH_TEST, GL_CULL_FACE, GL_STENCIL_TEST, GL_DITHER}) {
      if (glIsEnabled(state) == GL_TRUE) {
        glDisable(state);
        were_on_.push_back(state);
      }
    }
    glGetBooleanv(GL_COLOR_WRITEMASK, mask_.data());
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  ~PlainDrawing() {
    for (const GLenum state : were_on_) glEnable(state);
    glColorMask(mask_[0], mask_[1], mask_[2], mask_[3]);
  }
  PlainDrawing(const PlainDrawing&) = delete;
  PlainDrawing& operator=(const PlainDrawing&) = delete;

 private:
  std::vector<GLenum> were_on_;
  std::array<GLboolean, 4> mask_{};
};

}  // namespace

TurnedPicture::TurnedPicture(Size size) : size_(size), program_(make_program()) {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, size.width, size.height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw config::InputError("display: the driver draws no picture of " +
                             std::to_string(size.width) + "x" + std::to_string(size.height));
  }
  glGenVertexArrays(1, &vertex_array_);
  picture_from_panel_ = glGetUniformLocation(program_, "picture_from_panel");
}

void TurnedPicture::put(unsigned panel_framebuffer, Size panel, Rotation rotation) const {
  const PlainDrawing plain;
  const Area area = placed(size_, rotation, panel);
  glBindFramebuffer(GL_FRAMEBUFFER, panel_framebuffer);
  if (area.size != panel) {
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
  }
  glViewport(area.x, area.y, area.size.width, area.size.height);
  glUseProgram(program_);
  glUniformMatrix2fv(picture_from_panel_, 1, GL_FALSE, picture_from_panel(rotation).data());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glBindSampler(0, 0);
  const GLint filter = area.size == turned(size_, rotation) ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glBindVertexArray(vertex_array_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace lumibox::hal::kms
