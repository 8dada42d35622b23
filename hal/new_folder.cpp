#include "hal/new_folder.h"

#include <system_error>

#include "config/error.h"

namespace lumibox::hal {

void require_new_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) {
    return;
  }
  if (!std::filesystem::is_directory(folder, error)) {
    throw config::InputError(folder, "is a file; expected an empty or absent folder");
  }
  if (!std::filesystem::is_empty(folder, error)) {
    throw config::InputError(folder, error ? "cannot be read: " + error.message()
                                           : "is not empty; expected an empty or absent folder");
  }
}

}  // namespace lumibox::hal
