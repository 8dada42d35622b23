#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/buttons_rig.h"

// What all buttons promise, whatever is behind them; buttons_rig.h says how a backend takes part.
namespace lumibox::testing {

using hal::Button;
using hal::ButtonAction;
using hal::ButtonEvent;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;

namespace {

constexpr std::int64_t kMs = 1'000'000;

/// By when an edge is told: the quiet time after it and a beat of the loop.
constexpr std::int64_t kSoonNs = 60 * kMs;

ButtonEvent pressed(Button button, std::int64_t at_ms) {
  return {button, ButtonAction::Pressed, at_ms * kMs};
}

ButtonEvent released(Button button, std::int64_t at_ms) {
  return {button, ButtonAction::Released, at_ms * kMs};
}

}  // namespace

TEST_P(EveryButtons, SayNothingUnlessPressed) {
  EXPECT_THAT(play({}, 200 * kMs), IsEmpty());
  EXPECT_EQ(buttons_->error(), std::nullopt);
}

TEST_P(EveryButtons, TellEachEdgeOnceWithItsTime) {
  const std::vector<ButtonEvent> plan = {pressed(Button::Main, 100), released(Button::Main, 190),
                                         pressed(Button::Main, 310), released(Button::Main, 450)};
  expect_told(play(plan, 600 * kMs), plan);
  EXPECT_THAT(go_on(620 * kMs, 700 * kMs), IsEmpty());
}

TEST_P(EveryButtons, TellEdgesSoonAndNotBeforeTheirTime) {
  const std::vector<ButtonEvent> plan = {pressed(Button::Plus, 100), released(Button::Plus, 200)};
  EXPECT_THAT(play(plan, 90 * kMs, 90 * kMs), IsEmpty());
  expect_told(go_on(100 * kMs, 100 * kMs + kSoonNs), {plan[0]});
  expect_told(go_on(200 * kMs, 200 * kMs + kSoonNs), {plan[1]});
}

TEST_P(EveryButtons, AreFive) {
  std::vector<ButtonEvent> plan;
  for (const Button button : hal::kAllButtons) {
    const auto at_ms = static_cast<std::int64_t>(100 * (1 + index_of(button)));
    plan.push_back(pressed(button, at_ms));
    plan.push_back(released(button, at_ms + 50));
  }
  expect_told(play(plan, 700 * kMs), plan);
}

TEST_P(EveryButtons, AreToldApartWhenHeldTogether) {
  const std::vector<ButtonEvent> plan = {
      pressed(Button::Main, 100),  pressed(Button::Wipe, 140),    pressed(Button::Review, 180),
      released(Button::Main, 220), released(Button::Review, 260), released(Button::Wipe, 300)};
  expect_told(play(plan, 400 * kMs), plan);
}

TEST_P(EveryButtons, TellEverythingInOrderWhenTheLoopWasBusy) {
  const std::vector<ButtonEvent> plan = {
      pressed(Button::Minus, 50),  pressed(Button::Plus, 90),   released(Button::Minus, 130),
      released(Button::Plus, 170), pressed(Button::Minus, 210), released(Button::Minus, 250)};
  expect_told(play(plan, 400 * kMs, 400 * kMs), plan);
}

TEST_P(HardwareButtons, SayNothingOfAButtonThatIsHeldFromTheStartUntilItsNextPress) {
  const std::vector<ButtonEvent> plan = {pressed(Button::Main, -50), released(Button::Main, 100),
                                         pressed(Button::Main, 200), released(Button::Main, 300)};
  expect_told(play(plan, 400 * kMs), {plan[2], plan[3]});
}

TEST_P(HardwareButtons, ReleaseAStuckButtonAndSayWhichUntilItReallyIs) {
  constexpr auto kStuckMs = static_cast<std::int64_t>(1000 * kRigStuckS);
  const std::vector<ButtonEvent> plan = {
      pressed(Button::Wipe, 100), released(Button::Wipe, 300 + kStuckMs),
      pressed(Button::Wipe, 400 + kStuckMs), released(Button::Wipe, 450 + kStuckMs)};
  expect_told(play(plan, (kStuckMs + 200) * kMs),
              {plan[0], released(Button::Wipe, 100 + kStuckMs)});
  EXPECT_THAT(buttons_->error(), Optional(HasSubstr("wipe")));
  expect_told(go_on((kStuckMs + 300) * kMs, (kStuckMs + 550) * kMs), {plan[2], plan[3]});
  EXPECT_EQ(buttons_->error(), std::nullopt);
}

TEST_P(HardwareButtons, SayThatAButtonIsStuckFromTheStart) {
  constexpr auto kStuckMs = static_cast<std::int64_t>(1000 * kRigStuckS);
  EXPECT_THAT(play({pressed(Button::Review, -50)}, (kStuckMs + 100) * kMs), IsEmpty());
  EXPECT_THAT(buttons_->error(), Optional(HasSubstr("review")));
}

}  // namespace lumibox::testing
