#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "config/error.h"
#include "hal/offscreen/offscreen_display.h"

namespace lumibox::test {

/// A test that draws; skipped where there is no EGL to draw with.
class GlTest : public ::testing::Test {
 protected:
  /// A display of this size, its context current; null, and the test skipped, if there is none.
  static std::unique_ptr<hal::OffscreenDisplay> open_display(int width, int height) {
    try {
      auto display = std::make_unique<hal::OffscreenDisplay>(width, height);
      display->make_current();
      return display;
    } catch (const config::InputError& error) {
      [&] { GTEST_SKIP() << "nothing to draw with: " << error.what(); }();
      return nullptr;
    }
  }
};

}  // namespace lumibox::test
