#include "app/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace lumibox::app {

Progress::Progress(std::string what, std::int64_t total)
    : what_(std::move(what)), total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_percent_ >= 0) {
    std::fputc('\n', stderr);
  }
}

void Progress::show(std::int64_t done) {
  const int percent = total_ > 0 ? static_cast<int>(100 * done / total_) : 100;
  if (!on_terminal_ || percent == shown_percent_) {
    return;
  }
  shown_percent_ = percent;
  constexpr int kWidth = 40;
  const std::string filled(static_cast<std::size_t>(kWidth * percent / 100), '#');
  std::fprintf(stderr, "\r%s [%-*s] %3d%%", what_.c_str(), kWidth, filled.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace lumibox::app
