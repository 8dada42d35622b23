#include "hal/gpiod/gpio_line.h"

#include <cerrno>
#include <charconv>

#include "config/error_text.h"

namespace lumibox::hal {
namespace {

config::InputError refusal(const LineRequest& request, const std::string& why) {
  return config::InputError(request.option + ": line \"" + request.line + "\": " + why);
}

bool is_denied(int error) {
  return error == EACCES || error == EPERM;
}

constexpr const char* kNoPermission =
    "no permission to open its chip; expected a user in the group that owns /dev/gpiochip*";

}  // namespace

LinePlace place_of(const LineRequest& request) {
  const std::string& line = request.line;
  const std::size_t colon = line.rfind(':');
  unsigned offset = 0;
  if (colon != std::string::npos && colon > 0) {
    const char* const end = line.data() + line.size();
    const auto number = std::from_chars(line.data() + colon + 1, end, offset);
    if (number.ec == std::errc() && number.ptr == end) {
      return {line.substr(0, colon), {}, offset};
    }
  }
  return {{}, line, 0};
}

config::InputError no_such_chip(const LineRequest& request, int error) {
  if (is_denied(error)) {
    return refusal(request, kNoPermission);
  }
  return refusal(request, "no such chip (" + config::error_text(error) +
                              "); expected CHIP:OFFSET with a chip as gpiodetect lists it");
}

config::InputError no_such_line(const LineRequest& request, int error) {
  if (is_denied(error)) {
    return refusal(request, kNoPermission);
  }
  return refusal(request, "not on any chip (" + config::error_text(error) +
                              "); expected a name, or CHIP:OFFSET, as gpioinfo lists it");
}

config::InputError no_such_offset(const LineRequest& request, std::size_t lines) {
  return refusal(request, "chip \"" + place_of(request).chip + "\" has " + std::to_string(lines) +
                              " lines; expected an offset below that, as gpioinfo lists it");
}

config::InputError not_given(const LineRequest& request, int error, const char* user) {
  if (error == EBUSY) {
    const bool known = user != nullptr && *user != '\0';
    return refusal(request, "in use" + (known ? " by \"" + std::string(user) + "\"" : "") +
                                "; expected a free line");
  }
  return refusal(request, "refused by the kernel (" + config::error_text(error) +
                              "); expected a line that tells edges, with the bias asked for");
}

}  // namespace lumibox::hal
