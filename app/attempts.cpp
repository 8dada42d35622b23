#include "app/attempts.h"

#include "config/log.h"

namespace lumibox::app {

void Attempts::attempt(const std::function<void()>& step) {
  try {
    step();
  } catch (const std::exception& error) {
    if (first_) {
      config::log_error(error.what());
    } else {
      first_ = std::current_exception();
    }
  }
}

void Attempts::rethrow_first() const {
  if (first_) {
    std::rethrow_exception(first_);
  }
}

}  // namespace lumibox::app
