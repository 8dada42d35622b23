#include "app/lamp.h"

#include <gtest/gtest.h>

namespace lumibox::app {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Lamp, IsLitWhileNewViewsAreRecorded) {
  Lamp lamp;
  EXPECT_FALSE(lamp.is_lit(false, false, 0));
  EXPECT_TRUE(lamp.is_lit(true, false, 33 * kMs));
  EXPECT_FALSE(lamp.is_lit(false, false, 66 * kMs));
}

TEST(Lamp, IsDarkForAMomentAfterEachPicture) {
  Lamp lamp;
  EXPECT_FALSE(lamp.is_lit(true, true, 1000 * kMs));
  EXPECT_FALSE(lamp.is_lit(true, false, 1099 * kMs));
  EXPECT_TRUE(lamp.is_lit(true, false, 1100 * kMs));
}

}  // namespace
}  // namespace lumibox::app
