#include "hal/hold_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace lumibox::hal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kStuckS = 60.0;

ButtonEvent pressed(Button button, std::int64_t at_ns) {
  return {button, ButtonAction::Pressed, at_ns};
}

ButtonEvent released(Button button, std::int64_t at_ns) {
  return {button, ButtonAction::Released, at_ns};
}

TEST(HoldGuard, PressesPass) {
  HoldGuard guard(kStuckS);
  EXPECT_THAT(guard.pass({pressed(Button::Main, 1), pressed(Button::Plus, 2)}, 5),
              ElementsAre(pressed(Button::Main, 1), pressed(Button::Plus, 2)));
  EXPECT_THAT(guard.pass({released(Button::Main, 6)}, 7), ElementsAre(released(Button::Main, 6)));
  EXPECT_EQ(guard.error(), std::nullopt);
}

TEST(HoldGuard, AButtonThatIsHeldAtTheStartIsHeardOnceItWasReleased) {
  HoldGuard guard(kStuckS);
  guard.held_at_start(Button::Wipe, 0);
  EXPECT_THAT(guard.pass({released(Button::Wipe, 1)}, 2), IsEmpty());
  EXPECT_THAT(guard.pass({pressed(Button::Wipe, 3), released(Button::Wipe, 4)}, 5),
              ElementsAre(pressed(Button::Wipe, 3), released(Button::Wipe, 4)));
}

TEST(HoldGuard, AStuckButtonIsReleasedAndToldUntilItReallyIs) {
  HoldGuard guard(kStuckS);
  guard.pass({pressed(Button::Review, 0)}, 0);
  EXPECT_THAT(guard.pass({}, 60 * kSecond - 1), IsEmpty());
  EXPECT_EQ(guard.error(), std::nullopt);

  EXPECT_THAT(guard.pass({}, 61 * kSecond), ElementsAre(released(Button::Review, 60 * kSecond)));
  EXPECT_THAT(guard.error(), Optional(HasSubstr("review")));
  EXPECT_THAT(guard.pass({}, 200 * kSecond), IsEmpty());

  EXPECT_THAT(guard.pass({released(Button::Review, 201 * kSecond)}, 201 * kSecond), IsEmpty());
  EXPECT_EQ(guard.error(), std::nullopt);
  EXPECT_THAT(guard.pass({pressed(Button::Review, 202 * kSecond)}, 203 * kSecond),
              ElementsAre(pressed(Button::Review, 202 * kSecond)));
}

TEST(HoldGuard, AButtonThatIsStuckFromTheStartIsTold) {
  HoldGuard guard(kStuckS);
  guard.held_at_start(Button::Minus, 10 * kSecond);
  guard.held_at_start(Button::Plus, 10 * kSecond);
  EXPECT_THAT(guard.pass({}, 69 * kSecond), IsEmpty());
  EXPECT_EQ(guard.error(), std::nullopt);
  EXPECT_THAT(guard.pass({}, 70 * kSecond), IsEmpty());
  EXPECT_EQ(guard.error(), "stuck: plus, minus");
}

// Once everything is up again as many releases as presses have been heard, in turn and in order.
RC_GTEST_PROP(HoldGuard, WhatIsHeardAlternates, ()) {
  HoldGuard guard(kStuckS);
  std::int64_t now_ns = 0;
  bool down = *rc::gen::arbitrary<bool>();
  if (down) {
    guard.held_at_start(Button::Main, now_ns);
  }
  std::vector<ButtonEvent> heard;
  const int steps = 2 * *rc::gen::inRange(1, 10) + (down ? 1 : 0);
  const auto hear = [&](const std::vector<ButtonEvent>& edges) {
    for (const ButtonEvent& event : guard.pass(edges, now_ns)) heard.push_back(event);
  };
  for (int i = 0; i < steps; ++i) {
    now_ns += *rc::gen::inRange<std::int64_t>(1, 80 * kSecond);
    hear({});
    now_ns += *rc::gen::inRange<std::int64_t>(1, 80 * kSecond);
    down = !down;
    hear({down ? pressed(Button::Main, now_ns) : released(Button::Main, now_ns)});
  }
  RC_ASSERT(heard.size() % 2 == 0U);
  for (std::size_t i = 0; i < heard.size(); ++i) {
    RC_ASSERT((heard[i].action == ButtonAction::Pressed) == (i % 2 == 0));
    RC_ASSERT(i == 0 || heard[i].timestamp_ns >= heard[i - 1].timestamp_ns);
  }
  RC_ASSERT(!guard.error());
}

}  // namespace
}  // namespace lumibox::hal
