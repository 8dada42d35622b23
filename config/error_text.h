#pragma once

#include <string>
#include <system_error>

namespace lumibox::config {

/// The system's words for an errno.
inline std::string error_text(int error) {
  return std::generic_category().message(error);
}

}  // namespace lumibox::config
