#include "app/commands/recorded.h"

#include <algorithm>
#include <system_error>

#include "config/error.h"
#include "lightfield/map_files.h"
#include "lightfield/transforms.h"

namespace lumibox::app {
namespace {

namespace fs = std::filesystem;

/// Where that which is written to `path` ends up.
fs::path destination(fs::path path) {
  constexpr int kMostLinks = 40;  // as many as the system follows
  std::error_code ignored;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, ignored); ++i) {
    path = path.parent_path() / fs::read_symlink(path, ignored);
  }
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

/// True if `path` is `folder` or lies in it; both are destinations.
bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(path, folder).in2 == folder.end();
}

/// True also for two names of one file (hard links).
bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return destination(a) == destination(b) || fs::equivalent(a, b, ignored);
}

bool is_recorded(const fs::path& result, const fs::path& capture) {
  for (const char* file : {lightfield::kTransformsFile, lightfield::kPointsFile}) {
    if (is_same(result, capture / file)) return true;
  }
  const fs::path target = destination(result);
  for (const char* folder : {lightfield::kImagesFolder, lightfield::kMapFolder}) {
    if (is_inside(target, destination(capture / folder))) return true;
  }
  return false;
}

void require_free(const fs::path& result, const fs::path& capture) {
  if (!is_recorded(result, capture)) return;
  throw config::InputError(result, "belongs to the capture in " + capture.string() +
                                       "; nothing recorded is ever overwritten");
}

/// True if it is one of the files that open_sequence() reads or would read if it were there.
bool is_file_of(const hal::Sequence& sequence, const fs::path& result) {
  std::error_code ignored;
  if (!fs::is_directory(sequence.path, ignored)) return is_same(result, sequence.path);
  for (const char* file : {"rgb.txt", "rgb.mp4", "calib.txt", "groundtruth.txt", "subject.txt"}) {
    if (is_same(result, sequence.path / file)) return true;
  }
  return fs::exists(result, ignored) &&
         std::ranges::any_of(sequence.entries, [&](const hal::Sequence::Entry& entry) {
           return fs::equivalent(result, entry.image, ignored);
         });
}

}  // namespace

void refuse_recorded(const fs::path& result) {
  std::error_code ignored;
  const fs::path target = destination(result);
  for (fs::path folder = target.parent_path();; folder = folder.parent_path()) {
    if (fs::exists(folder / lightfield::kTransformsFile, ignored)) require_free(result, folder);
    if (folder == folder.parent_path()) return;
  }
}

void refuse_recorded(const fs::path& result, const fs::path& capture) {
  refuse_recorded(result);
  require_free(result, capture);
}

void refuse_recorded(const fs::path& result, const hal::Sequence& sequence) {
  if (is_file_of(sequence, result)) {
    throw config::InputError(result, "belongs to the recording in " + sequence.path.string() +
                                         "; nothing recorded is ever overwritten");
  }
}

void refuse_inside(const fs::path& result, const fs::path& capture) {
  if (is_inside(destination(result), destination(capture))) {
    throw config::InputError(result, "lies in the capture in " + capture.string() +
                                         "; expected a result beside its folder");
  }
}

}  // namespace lumibox::app
