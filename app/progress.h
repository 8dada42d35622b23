#pragma once

#include <cstdint>
#include <string>

namespace lumibox::app {

/// A line on stderr that says how far a long work has come; silent unless stderr is a terminal.
class Progress {
 public:
  Progress(std::string what, std::int64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::int64_t done);

 private:
  std::string what_;
  std::int64_t total_;
  int shown_percent_ = -1;
  bool on_terminal_;
};

}  // namespace lumibox::app
