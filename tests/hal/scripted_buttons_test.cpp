#include "hal/scripted/scripted_buttons.h"

#include <gtest/gtest.h>

#include "hal/sim/virtual_clock.h"

namespace lumibox::hal {
namespace {

TEST(ScriptedButtons, AppearWhenTheClockReachesThemInOrderAndOnce) {
  VirtualClock clock;
  ScriptedButtons buttons({{Button::Plus, ButtonAction::Pressed, 300},
                           {Button::Main, ButtonAction::Pressed, 100},
                           {Button::Main, ButtonAction::Released, 200}},
                          clock);
  EXPECT_TRUE(buttons.poll().empty());

  clock.wait_until(99);
  EXPECT_TRUE(buttons.poll().empty());

  clock.wait_until(200);
  const std::vector<ButtonEvent> press = buttons.poll();
  ASSERT_EQ(press.size(), 2U);
  EXPECT_EQ(press[0].action, ButtonAction::Pressed);
  EXPECT_EQ(press[0].timestamp_ns, 100);
  EXPECT_EQ(press[1].action, ButtonAction::Released);
  EXPECT_TRUE(buttons.poll().empty());

  clock.wait_until(1000);
  ASSERT_EQ(buttons.poll().size(), 1U);
  EXPECT_TRUE(buttons.poll().empty());
}

// A real clock began when the machine did.
TEST(ScriptedButtons, TimesCountFromWhenTheyAreMade) {
  VirtualClock clock;
  clock.wait_until(5000);
  ScriptedButtons buttons({{Button::Main, ButtonAction::Pressed, 100}}, clock);
  EXPECT_TRUE(buttons.poll().empty());
  clock.wait_until(5100);
  const std::vector<ButtonEvent> press = buttons.poll();
  ASSERT_EQ(press.size(), 1U);
  EXPECT_EQ(press[0].timestamp_ns, 5100);
}

}  // namespace
}  // namespace lumibox::hal
