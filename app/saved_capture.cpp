#include "app/saved_capture.h"

#include <fmt/core.h>

#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/error.h"
#include "config/log.h"
#include "lightfield/map_files.h"

namespace lumibox::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "capture-";

fs::path capture_folder(const fs::path& captures, int number) {
  return captures / fmt::format("{}{:04}", kPrefix, number);
}

/// Number of the last capture; 0 if there is none.
int last_number(const fs::path& captures) {
  int last = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(captures, error)) {
    const std::string name = entry.path().filename().string();
    int number = 0;
    if (!name.starts_with(kPrefix)) {
      continue;
    }
    std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), number);
    if (number > last && entry.path() == capture_folder(captures, number)) {
      last = number;
    }
  }
  return last;
}

}  // namespace

SavedCapture load_saved_capture(const fs::path& folder, const geometry::Camera& camera,
                                int levels) {
  SavedCapture saved;
  saved.capture = lightfield::load_capture(folder);
  try {
    saved.map =
        std::make_shared<const tracking::MapView>(lightfield::read_map(folder, camera, levels));
  } catch (const config::InputError& error) {
    saved.problem = error.what();
  }
  return saved;
}

std::optional<SavedCapture> find_saved_capture(const fs::path& captures,
                                               const geometry::Camera& camera, int levels) {
  const int last = last_number(captures);
  if (last == 0) {
    return std::nullopt;
  }
  const fs::path folder = capture_folder(captures, last);
  try {
    lightfield::CaptureLock lock(folder);
    SavedCapture saved = load_saved_capture(folder, camera, levels);
    saved.lock = std::move(lock);
    const auto& light_field = saved.capture.light_field;
    if (light_field.perspectives().empty() || !light_field.subject()) {
      return std::nullopt;
    }
    if (!saved.problem.empty()) {
      config::log_warning(saved.problem);
    }
    return saved;
  } catch (const lightfield::CaptureInUse&) {
    throw;
  } catch (const config::InputError& error) {
    config::log_warning(error.what());
    return std::nullopt;
  }
}

fs::path next_capture_folder(const fs::path& captures) {
  return capture_folder(captures, last_number(captures) + 1);
}

}  // namespace lumibox::app
