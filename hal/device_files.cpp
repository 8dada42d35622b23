#include "hal/device_files.h"

#include <algorithm>
#include <system_error>

namespace lumibox::hal {

namespace fs = std::filesystem;

std::vector<fs::path> device_files(const fs::path& folder, std::string_view prefix) {
  std::vector<fs::path> files;
  std::error_code error;  // going on may fail as well as beginning
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with(prefix)) files.push_back(entry->path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace lumibox::hal
