#include "lightfield/picture_path.h"

#include "config/error.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {

namespace fs = std::filesystem;

bool stays_inside(const std::string& path) {
  // A zero byte would end the name early for the system but not for us.
  if (path.empty() || path.find('\0') != std::string::npos) return false;
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.is_relative() && normal != "." && *normal.begin() != "..";
}

void require_pictures(const fs::path& file, const fs::path& folder,
                      const std::vector<std::string>& pictures) {
  constexpr int kMostNamed = 5;
  int missing = 0;
  std::string names;
  for (const std::string& picture : pictures) {
    std::error_code error;
    if (fs::is_regular_file(folder / picture, error)) continue;
    if (++missing <= kMostNamed) names += (missing > 1 ? ", " : "") + printable(picture);
  }
  if (missing == 0) return;
  if (missing > kMostNamed) names += ", ...";
  throw config::InputError(file, std::to_string(missing) + " of " +
                                     std::to_string(pictures.size()) + " pictures are missing in " +
                                     (folder.empty() ? "." : folder.string()) + ": " + names);
}

}  // namespace lumibox::lightfield
