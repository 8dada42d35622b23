#pragma once

#include <gtest/gtest.h>

#include <cfenv>

namespace lumibox {

/// Tests in which an invalid operation, a division by zero or an overflow ends the program at the
/// spot, rather than a NaN going unnoticed.
class Trapped : public ::testing::Test {
 protected:
  void SetUp() override {
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  }
  void TearDown() override { fedisableexcept(FE_ALL_EXCEPT); }
};

}  // namespace lumibox
