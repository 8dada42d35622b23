#pragma once

#include <GLES3/gl3.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumibox::render::gl {

/// Owns the name of a GL object; `destroy` frees it. Needs the context current when it ends.
template <void (*destroy)(GLuint)>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0) destroy(name_);
  }
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

void delete_buffer(GLuint name);
void delete_texture(GLuint name);
void delete_program(GLuint name);
void delete_shader(GLuint name);
void delete_vertex_array(GLuint name);
void delete_framebuffer(GLuint name);

using Buffer = Object<delete_buffer>;
using Texture = Object<delete_texture>;
using Program = Object<delete_program>;
using Shader = Object<delete_shader>;
using VertexArray = Object<delete_vertex_array>;
using Framebuffer = Object<delete_framebuffer>;

Buffer make_buffer();
VertexArray make_vertex_array();
Framebuffer make_framebuffer();

/// A texture with linear filtering, no mipmaps and clamped edges, left bound to `target`.
Texture make_texture(GLenum target);

/// What went wrong before is of no interest to who asks glGetError() next.
void forget_errors();

/// Links a program of two files of render/shaders/. `shared` stands before both, `prelude` before
/// the fragment shader: definitions, and files that they use. Throws config::InputError with the
/// driver's log.
Program make_program(std::string_view vertex_file, std::string_view fragment_file,
                     std::string_view shared = {}, std::string_view prelude = {});

/// A shader after the lines that all share (version, precision), and what the log calls it.
struct ShaderText {
  std::string name;
  std::string text;
};

/// The same of shaders that are no files.
Program make_program(const ShaderText& vertex, const ShaderText& fragment);

GLint uniform(const Program& program, const char* name);

/// The program takes the uniform block from a binding point.
void bind_block(const Program& program, const char* name, GLuint binding);

/// Binds a framebuffer and sets the state that everything here draws with: no depth, no culling,
/// blending as asked ("over": source alpha).
enum class Blend { Replace, Over };
void begin(unsigned framebuffer, int width, int height, Blend blend);

}  // namespace lumibox::render::gl
