#pragma once

#include <string>

#include "config/error.h"

namespace lumibox::testing {

/// The message of the InputError that `action` throws; empty if it throws none.
template <typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const config::InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace lumibox::testing
