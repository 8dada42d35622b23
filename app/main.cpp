#include <cerrno>
#include <cstdio>

#include "app/commands/command_line.h"
#include "config/error.h"
#include "config/error_text.h"
#include "config/log.h"

namespace {

/// What was said may have reached nobody: a full disk behind a redirection.
void require_output_written() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw lumibox::config::InputError("standard output cannot be written: " +
                                      lumibox::config::error_text(errno));
  }
}

}  // namespace

int main(int argc, char** argv) {
  lumibox::config::start_log();
  try {
    const int status = lumibox::app::run_command_line(argc, argv);
    require_output_written();
    return status;
  } catch (const lumibox::config::InputError& error) {
    std::fprintf(stderr, "lumibox: %s\n", error.what());
    return lumibox::app::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lumibox: unexpected error: %s\n", error.what());
    return lumibox::app::kBadInput;
  }
}
