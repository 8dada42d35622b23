#pragma once

#include <string_view>

namespace lumibox::render {

/// Text of a file in render/shaders/, embedded when the program was built.
std::string_view shader_source(std::string_view name);

}  // namespace lumibox::render
