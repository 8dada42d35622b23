#include <cstdio>

#include "app/commands/command_line.h"
#include "config/error.h"
#include "config/log.h"

int main(int argc, char** argv) {
  lumibox::config::start_log();
  try {
    return lumibox::app::run_command_line(argc, argv);
  } catch (const lumibox::config::InputError& error) {
    std::fprintf(stderr, "lumibox: %s\n", error.what());
    return lumibox::app::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lumibox: unexpected error: %s\n", error.what());
    return lumibox::app::kBadInput;
  }
}
