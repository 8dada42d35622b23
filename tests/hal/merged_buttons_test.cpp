#include "hal/merged_buttons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "hal/scripted/scripted_buttons.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox::hal {
namespace {

using ::testing::ElementsAre;

ButtonEvent pressed(Button button, std::int64_t at_ns) {
  return {button, ButtonAction::Pressed, at_ns};
}

ButtonEvent released(Button button, std::int64_t at_ns) {
  return {button, ButtonAction::Released, at_ns};
}

class Faulty : public Buttons {
 public:
  explicit Faulty(std::optional<std::string> error) : error_(std::move(error)) {}
  std::vector<ButtonEvent> poll() override { return {}; }
  std::optional<std::string> error() const override { return error_; }

 private:
  std::optional<std::string> error_;
};

TEST(MergedButtons, TellsTheEdgesOfAllByTime) {
  VirtualClock clock;
  std::vector<std::unique_ptr<Buttons>> sources;
  sources.push_back(std::make_unique<ScriptedButtons>(
      std::vector{pressed(Button::Main, 10), released(Button::Main, 30)}, clock));
  sources.push_back(std::make_unique<ScriptedButtons>(
      std::vector{pressed(Button::Wipe, 20), released(Button::Wipe, 40)}, clock));
  MergedButtons buttons(std::move(sources));
  clock.wait_until(35);
  EXPECT_THAT(buttons.poll(), ElementsAre(pressed(Button::Main, 10), pressed(Button::Wipe, 20),
                                          released(Button::Main, 30)));
  clock.wait_until(100);
  EXPECT_THAT(buttons.poll(), ElementsAre(released(Button::Wipe, 40)));
}

TEST(MergedButtons, TellsWhatIsWrongWithEach) {
  std::vector<std::unique_ptr<Buttons>> sources;
  sources.push_back(std::make_unique<Faulty>("stuck: main"));
  sources.push_back(std::make_unique<Faulty>(std::nullopt));
  sources.push_back(std::make_unique<Faulty>("a remote is not there"));
  EXPECT_EQ(MergedButtons(std::move(sources)).error(), "stuck: main; a remote is not there");
  EXPECT_EQ(MergedButtons({}).error(), std::nullopt);
}

TEST(ButtonUnion, AButtonIsDownWhileAnySetHoldsIt) {
  ButtonUnion all;
  EXPECT_THAT(all.merge({pressed(Button::Plus, 1)}), ElementsAre(pressed(Button::Plus, 1)));
  EXPECT_THAT(all.merge({pressed(Button::Plus, 2), released(Button::Plus, 3)}), ElementsAre());
  EXPECT_THAT(all.merge({released(Button::Plus, 4)}), ElementsAre(released(Button::Plus, 4)));
}

TEST(ButtonUnion, WhoWasFirstIsToldByTimeNotByOrder) {
  ButtonUnion all;
  all.merge({pressed(Button::Plus, 1)});
  EXPECT_THAT(
      all.merge({released(Button::Plus, 4), pressed(Button::Plus, 3), released(Button::Plus, 6)}),
      ElementsAre(released(Button::Plus, 6)));
}

// A switch that is debounced is told of later than a key that was pressed after it.
TEST(ButtonUnion, WhatIsToldOfOneButtonGoesForwardInTime) {
  ButtonUnion all;
  EXPECT_THAT(all.merge({pressed(Button::Main, 5), released(Button::Main, 9)}),
              ElementsAre(pressed(Button::Main, 5), released(Button::Main, 9)));
  EXPECT_THAT(all.merge({pressed(Button::Main, 7)}), ElementsAre(pressed(Button::Main, 9)));
}

RC_GTEST_PROP(ButtonUnion, HowSeveralHandsEverPressEdgesAlternate, ()) {
  constexpr std::size_t kSets = 3;
  std::array<std::array<bool, 5>, kSets> down{};
  ButtonUnion all;
  std::array<int, 5> told{};
  std::int64_t at_ns = 0;
  const int ticks = *rc::gen::inRange(1, 40);
  for (int tick = 0; tick < ticks; ++tick) {
    std::vector<ButtonEvent> edges;
    const int count = *rc::gen::inRange(0, 4);
    for (int i = 0; i < count; ++i) {
      const auto set = *rc::gen::inRange<std::size_t>(0, kSets);
      const auto button = *rc::gen::inRange<std::size_t>(0, 5);
      at_ns += *rc::gen::inRange(0, 3);
      bool& held = down.at(set).at(button);
      held = !held;
      edges.push_back(
          {kAllButtons.at(button), held ? ButtonAction::Pressed : ButtonAction::Released, at_ns});
    }
    for (const ButtonEvent& edge : all.merge(edges)) {
      int& is_down = told.at(index_of(edge.button));
      is_down += edge.action == ButtonAction::Pressed ? 1 : -1;
      RC_ASSERT(is_down == 0 || is_down == 1);
    }
    for (std::size_t button = 0; button < 5; ++button) {
      const bool held = down[0].at(button) || down[1].at(button) || down[2].at(button);
      RC_ASSERT((told.at(button) == 1) == held);
    }
  }
}

}  // namespace
}  // namespace lumibox::hal
