#include "hal/live/refusal.h"

#include <cerrno>

#include "config/error_text.h"

namespace lumibox::hal::live {

std::string refusal(const std::string& what, int error) {
  const char* hint = error == EBUSY    ? "; is another program using it?"
                     : error == EACCES ? "; is the user in the group video?"
                                       : "";
  return what + ": " + config::error_text(error) + hint;
}

}  // namespace lumibox::hal::live
