#include "render/gl.h"

#include "config/error.h"
#include "render/shader_source.h"

namespace lumibox::render::gl {
namespace {

constexpr std::string_view kHeader =
    "#version 300 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n"
    "precision highp sampler2DArray;\n";

Shader compile(GLenum kind, const ShaderText& from) {
  Shader shader(glCreateShader(kind));
  const std::string text = std::string(kHeader) + from.text;
  const char* source = text.c_str();
  glShaderSource(shader.name(), 1, &source, nullptr);
  glCompileShader(shader.name());
  GLint done = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (done == 0) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw config::InputError("OpenGL ES 3 cannot compile the shader " + from.name + ": " + log);
  }
  return shader;
}

}  // namespace

void delete_buffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
void delete_texture(GLuint name) {
  glDeleteTextures(1, &name);
}
void delete_program(GLuint name) {
  glDeleteProgram(name);
}
void delete_shader(GLuint name) {
  glDeleteShader(name);
}
void delete_vertex_array(GLuint name) {
  glDeleteVertexArrays(1, &name);
}

void delete_framebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}

Buffer make_buffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return Buffer(name);
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return VertexArray(name);
}

Framebuffer make_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return Framebuffer(name);
}

Texture make_texture(GLenum target) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(target, name);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return Texture(name);
}

void forget_errors() {
  // ES 3 has fewer flags than this; a context that is lost would report its loss for ever.
  constexpr int kMostFlags = 8;
  for (int i = 0; i < kMostFlags && glGetError() != GL_NO_ERROR; ++i) {
  }
}

Program make_program(std::string_view vertex_file, std::string_view fragment_file,
                     std::string_view shared, std::string_view prelude) {
  const std::string before_both(shared);
  ShaderText vertex{std::string(vertex_file), before_both};
  vertex.text += shader_source(vertex_file);
  ShaderText fragment{std::string(fragment_file), before_both};
  fragment.text += prelude;
  fragment.text += shader_source(fragment_file);
  return make_program(vertex, fragment);
}

Program make_program(const ShaderText& vertex, const ShaderText& fragment) {
  const Shader vertex_shader = compile(GL_VERTEX_SHADER, vertex);
  const Shader fragment_shader = compile(GL_FRAGMENT_SHADER, fragment);
  Program program(glCreateProgram());
  glAttachShader(program.name(), vertex_shader.name());
  glAttachShader(program.name(), fragment_shader.name());
  glLinkProgram(program.name());
  GLint done = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &done);
  if (done == 0) {
    throw config::InputError("OpenGL ES 3 cannot link the shader " + fragment.name);
  }
  return program;
}

GLint uniform(const Program& program, const char* name) {
  return glGetUniformLocation(program.name(), name);
}

void bind_block(const Program& program, const char* name, GLuint binding) {
  glUniformBlockBinding(program.name(), glGetUniformBlockIndex(program.name(), name), binding);
}

void begin(unsigned framebuffer, int width, int height, Blend blend) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  if (blend == Blend::Over) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
}

}  // namespace lumibox::render::gl
