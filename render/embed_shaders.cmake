# Writes OUTPUT, a C++ source that defines lumibox::render::shader_source() from the files in SHADERS.
set(cases "")
foreach(file ${SHADERS})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND cases "  if (name == \"${name}\") return R\"glsl(${text})glsl\";\n")
endforeach()
file(WRITE ${OUTPUT}
"#include \"render/shader_source.h\"

#include <stdexcept>
#include <string>

namespace lumibox::render {

std::string_view shader_source(std::string_view name) {
${cases}  throw std::logic_error(\"no shader \" + std::string(name));
}

}  // namespace lumibox::render
")
