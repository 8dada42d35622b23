#include "app/attempts.h"

#include <stdexcept>

#include "config/error.h"

namespace lumibox::app {

void Attempts::attempt(const std::function<void()>& step) {
  try {
    step();
  } catch (const std::exception& error) {
    all_ += first_ ? std::string("; ") + error.what() : error.what();
    if (!first_) first_ = std::current_exception();
  }
}

void Attempts::rethrow() const {
  if (!first_) return;
  try {
    std::rethrow_exception(first_);
  } catch (const config::InputError&) {
    throw config::InputError(all_);
  } catch (const std::exception&) {
    throw std::runtime_error(all_);
  }
}

}  // namespace lumibox::app
