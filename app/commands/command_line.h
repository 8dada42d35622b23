#pragma once

namespace lumibox::app {

/// Exit statuses.
inline constexpr int kBadInput = 1;
inline constexpr int kBadUsage = 2;

/// Runs the command that the arguments name and returns the exit status; usage is explained and
/// complained about on the terminal. Throws what the commands throw.
int run_command_line(int argc, char** argv);

}  // namespace lumibox::app
