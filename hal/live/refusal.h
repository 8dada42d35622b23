#pragma once

#include <string>

namespace lumibox::hal::live {

/// "<what>: <why>" of a camera that refused (`error` is an errno), and what may help.
std::string refusal(const std::string& what, int error);

}  // namespace lumibox::hal::live
