#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "config/error.h"
#include "hal/debouncer.h"

namespace lumibox::hal {

enum class Bias { AsIs, PullUp, PullDown, Disabled };

/// A line as the configuration has it.
struct LineRequest {
  std::string option;  ///< that names it, for error messages: "gpio.main"
  std::string line;    ///< NAME or CHIP:OFFSET
  bool active_low = false;
  Bias bias = Bias::AsIs;
};

/// One line whose edges the kernel reports. libgpiod_1.cpp and libgpiod_2.cpp implement this and
/// the next on the two programming interfaces that libgpiod has had; the build takes one of them.
class GpioInput {
 public:
  /// Throws config::InputError: option, line, what is wrong with it, what was expected.
  explicit GpioInput(const LineRequest& request);
  ~GpioInput();
  GpioInput(GpioInput&&) noexcept;
  GpioInput& operator=(GpioInput&&) noexcept;

  /// Edges with the kernel's CLOCK_MONOTONIC times, and the level. None if the kernel no longer
  /// answers; errno says why. Never blocks.
  std::optional<LineReading> read();

 private:
  struct Line;
  std::unique_ptr<Line> line_;
};

/// One line that is driven: inactive at first, and again in the end.
class GpioOutput {
 public:
  explicit GpioOutput(const LineRequest& request);  ///< throws as GpioInput does
  ~GpioOutput();
  GpioOutput(const GpioOutput&) = delete;
  GpioOutput& operator=(const GpioOutput&) = delete;

  bool set(bool active);  ///< false if the kernel no longer answers

 private:
  struct Line;
  std::unique_ptr<Line> line_;
};

/// What the line is called where it is looked for.
struct LinePlace {
  std::string chip;     ///< name, label, path or number; empty: any chip
  std::string name;     ///< of the line; empty if there is an offset
  unsigned offset = 0;  ///< on the chip
};

/// "gpiochip0:17" is an offset; "GPIO17" and "spi:cs" are names.
LinePlace place_of(const LineRequest& request);

/// Says why a line is refused: `error` is an errno, `user` who has the line if that is known.
config::InputError no_such_chip(const LineRequest& request, int error);
config::InputError no_such_line(const LineRequest& request, int error);
config::InputError no_such_offset(const LineRequest& request, std::size_t lines);  ///< of its chip
config::InputError not_given(const LineRequest& request, int error, const char* user);

}  // namespace lumibox::hal
