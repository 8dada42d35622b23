#include "app/gestures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

namespace lumibox::app {
namespace {

using hal::Button;
using hal::ButtonAction;
using hal::ButtonEvent;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kMs = 1'000'000;

ButtonEvent edge(Button button, ButtonAction action, std::int64_t ms) {
  return {button, action, ms * kMs};
}

TEST(Gestures, ShortPressIsToldOnRelease) {
  Gestures gestures(0.6);
  EXPECT_THAT(gestures.update({edge(Button::Plus, ButtonAction::Pressed, 0)}, 10 * kMs), IsEmpty());
  EXPECT_THAT(gestures.update({edge(Button::Plus, ButtonAction::Released, 599)}, 599 * kMs),
              ElementsAre(Gesture{Button::Plus, Press::Short}));
}

TEST(Gestures, LongPressIsToldWhileTheButtonIsStillDown) {
  Gestures gestures(0.6);
  gestures.update({edge(Button::Wipe, ButtonAction::Pressed, 100)}, 100 * kMs);
  EXPECT_THAT(gestures.update({}, 699 * kMs), IsEmpty());
  EXPECT_THAT(gestures.update({}, 700 * kMs), ElementsAre(Gesture{Button::Wipe, Press::Long}));
  EXPECT_THAT(gestures.update({}, 5000 * kMs), IsEmpty());
  EXPECT_THAT(gestures.update({edge(Button::Wipe, ButtonAction::Released, 5001)}, 5001 * kMs),
              IsEmpty());
}

TEST(Gestures, PressAndReleaseInOneTickAreToldByTheirOwnTimes) {
  Gestures gestures(0.6);
  EXPECT_THAT(gestures.update({edge(Button::Main, ButtonAction::Pressed, 0),
                               edge(Button::Main, ButtonAction::Released, 50),
                               edge(Button::Main, ButtonAction::Pressed, 100),
                               edge(Button::Main, ButtonAction::Released, 800)},
                              900 * kMs),
              ElementsAre(Gesture{Button::Main, Press::Short}, Gesture{Button::Main, Press::Long}));
}

TEST(Gestures, ReleaseWithoutPressMeansNothing) {
  Gestures gestures(0.6);
  EXPECT_THAT(gestures.update({edge(Button::Main, ButtonAction::Released, 0)}, 0), IsEmpty());
}

// However presses of all buttons interleave and however the time is cut into ticks: one gesture per
// press, of the right button and length.
RC_GTEST_PROP(Gestures, EveryPressGivesOneGesture, ()) {
  struct Made {
    std::map<Button, std::vector<Press>> presses;
  } made;
  std::vector<ButtonEvent> edges;
  for (int b = 0; b < 5; ++b) {
    const auto button = static_cast<Button>(b);
    std::int64_t at_ms = *rc::gen::inRange<std::int64_t>(0, 500);
    const int count = *rc::gen::inRange(0, 6);
    for (int i = 0; i < count; ++i) {
      const auto held_ms = *rc::gen::inRange<std::int64_t>(1, 1500);
      edges.push_back(edge(button, ButtonAction::Pressed, at_ms));
      edges.push_back(edge(button, ButtonAction::Released, at_ms + held_ms));
      made.presses[button].push_back(held_ms >= 600 ? Press::Long : Press::Short);
      at_ms += held_ms + *rc::gen::inRange<std::int64_t>(1, 500);
    }
  }
  std::ranges::stable_sort(edges, {}, &ButtonEvent::timestamp_ns);

  Gestures gestures(0.6);
  std::map<Button, std::vector<Press>> told;
  std::size_t next = 0;
  for (std::int64_t now_ms = 0; now_ms < 20'000; now_ms += *rc::gen::inRange(1, 400)) {
    std::vector<ButtonEvent> due;
    for (; next < edges.size() && edges[next].timestamp_ns <= now_ms * kMs; ++next) {
      due.push_back(edges[next]);
    }
    for (const Gesture& gesture : gestures.update(due, now_ms * kMs)) {
      told[gesture.button].push_back(gesture.press);
    }
  }
  RC_ASSERT(told == made.presses);
}

}  // namespace
}  // namespace lumibox::app
