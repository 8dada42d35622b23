// Which card, screen, mode and format: what is chosen, and what is said if there is none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cerrno>

#include "config/error.h"
#include "hal/fake_card.h"
#include "hal/kms/output.h"
#include "support/input_error.h"

namespace lumibox::hal::kms {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string chosen(const std::vector<Mode>& modes, std::string_view wish) {
  const auto mode = choose_mode(modes, parse_mode_wish(wish));
  return mode ? name_of(*mode) : "none";
}

TEST(ModeWish, IsASizeAndMayBeARate) {
  EXPECT_EQ(parse_mode_wish("1280x720")->size, (Size{1280, 720}));
  EXPECT_FALSE(parse_mode_wish("1280x720")->refresh_hz);
  EXPECT_EQ(parse_mode_wish("640x480@59.94")->refresh_hz, 59.94);
  for (const char* text : {"", "x", "640", "640x", "x480", "640x480@", "640x480@nan", "640x480 ",
                           "-640x480", "0x480", "640x480@0", "640x480@60i", "99999x480"}) {
    EXPECT_FALSE(parse_mode_wish(text)) << text;
  }
}

RC_GTEST_PROP(ModeWish, IsReadAsItIsNamed, ()) {
  Mode wished =
      mode(*rc::gen::inRange(1, 8000), *rc::gen::inRange(1, 8000), *rc::gen::inRange(1, 500));
  const auto wish = parse_mode_wish(name_of(wished));
  RC_ASSERT(wish.has_value());
  RC_ASSERT(wish->size == wished.size);
  RC_ASSERT(*wish->refresh_hz == wished.refresh_hz);
}

TEST(ChooseMode, WithoutAWishWhatTheScreenPrefers) {
  EXPECT_EQ(chosen({mode(1920, 1080, 60), mode(1280, 720, 60, true)}, ""), "1280x720@60");
  EXPECT_EQ(chosen({mode(640, 480, 75), mode(800, 600, 60), mode(800, 600, 75)}, ""), "800x600@75");
  EXPECT_EQ(chosen({}, ""), "none");
}

TEST(ChooseMode, AWishIsMetOrNot) {
  const std::vector<Mode> modes = {mode(1920, 1080, 60, true), mode(1280, 720, 60),
                                   mode(1280, 720, 50), mode(1280, 720, 59.94)};
  EXPECT_EQ(chosen(modes, "1280x720@50"), "1280x720@50");
  EXPECT_EQ(choose_mode(modes, parse_mode_wish("1280x720@60"))->refresh_hz, 60.0);
  EXPECT_EQ(choose_mode(modes, parse_mode_wish("1280x720@59.9"))->refresh_hz, 59.94);
  EXPECT_EQ(chosen(modes, "1280x720"), "1280x720@60");
  EXPECT_EQ(chosen(modes, "1280x720@75"), "none");
  EXPECT_EQ(chosen(modes, "720x1280"), "none");
}

TEST(ChooseMode, WholePicturesGoBeforeInterlacedOnes) {
  Mode interlaced = mode(1280, 720, 60);
  interlaced.interlaced = true;
  EXPECT_EQ(chosen({interlaced, mode(1280, 720, 50)}, "1280x720"), "1280x720@50");
  EXPECT_EQ(chosen({interlaced}, "1280x720"), "1280x720i@60");
}

TEST(ChooseOutput, TheFirstScreenThatCanBeDriven) {
  Connector unplugged = screen(1, {});
  unplugged.connected = false;
  Connector without_engine = screen(2, {mode(640, 480, 60)});
  without_engine.crtcs.clear();
  const std::vector connectors = {unplugged, without_engine, screen(3, {mode(800, 600, 60)}),
                                  screen(4, {mode(1920, 1080, 60)})};
  const auto output = choose_output(connectors, std::nullopt);
  ASSERT_TRUE(output);
  EXPECT_EQ(output->pipe.connector, 3U);
  EXPECT_EQ(output->pipe.crtc, 103U);
  EXPECT_EQ(output->name, "HDMI-A-3");
  EXPECT_FALSE(choose_output(std::vector{unplugged, without_engine}, std::nullopt));
}

TEST(ChooseOutput, AnotherModeIsBetterThanNoPicture) {
  const std::vector connectors = {screen(1, {mode(800, 600, 60)})};
  EXPECT_EQ(choose_output(connectors, parse_mode_wish("640x480"))->mode.size, (Size{800, 600}));
}

/// What choose_card() complains of.
std::string complaint(const std::vector<CardFound>& cards, std::string_view asked_for = {},
                      std::string_view wish = {}) {
  return testing::message_of([&] { choose_card(cards, asked_for, parse_mode_wish(wish)); });
}

TEST(ChooseCard, TheFirstWithAScreen) {
  const std::vector<CardFound> cards = {
      {"/dev/dri/card0", 0, false, {}},
      {"/dev/dri/card1", 0, true, {}},
      {"/dev/dri/card2", 0, true, {screen(1, {mode(640, 480, 60)})}},
      {"/dev/dri/card3", 0, true, {screen(1, {mode(640, 480, 60)})}}};
  EXPECT_EQ(choose_card(cards, "", std::nullopt), 2U);
  EXPECT_EQ(choose_card(cards, "/dev/dri/card3", std::nullopt), 3U);
  EXPECT_THAT(complaint(cards, "/dev/dri/card0"), HasSubstr("card0: drives no screens"));
}

TEST(ChooseCard, SaysWhatIsMissing) {
  EXPECT_EQ(complaint({}), "display kms: no card; expected one in /dev/dri");
  EXPECT_THAT(complaint({{"/dev/dri/card0", EACCES, false, {}}}),
              AllOf(HasSubstr("/dev/dri/card0: permission denied"), HasSubstr("video and render")));
  EXPECT_THAT(complaint({{"/dev/dri/card7", ENOENT, false, {}}}, "/dev/dri/card7"),
              AllOf(HasSubstr("card7"), HasSubstr("No such file")));
  Connector unplugged = screen(1, {});
  unplugged.connected = false;
  EXPECT_THAT(
      complaint({{"/dev/dri/card0", 0, false, {}}, {"/dev/dri/card1", 0, true, {unplugged}}}),
      AllOf(HasSubstr("card0: drives no screens"),
            HasSubstr("card1: no screen is connected; expected one at HDMI-A-1")));
}

// A plug mends what is missing, but no permission and no mode.
TEST(ChooseCard, WhatMayComeIsToldFromWhatMayNot) {
  const auto choose = [](const CardFound& card) {
    return choose_card(std::vector{card}, "", parse_mode_wish("640x480"));
  };
  Connector unplugged = screen(1, {});
  unplugged.connected = false;
  EXPECT_THROW(choose_card({}, "", std::nullopt), config::Unavailable);
  EXPECT_THROW(choose({"/dev/dri/card0", ENOENT, false, {}}), config::Unavailable);
  EXPECT_THROW(choose({"/dev/dri/card0", 0, true, {unplugged}}), config::Unavailable);
  const auto refused_for_good = [&](const CardFound& card) {
    try {
      choose(card);
    } catch (const config::Unavailable&) {
      return false;
    } catch (const config::InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused_for_good({"/dev/dri/card0", EACCES, false, {}}));
  EXPECT_TRUE(refused_for_good({"/dev/dri/card0", 0, true, {screen(1, {mode(800, 600, 60)})}}));
}

TEST(ChooseCard, ListsTheModesThatThereAre) {
  const std::vector<CardFound> cards = {
      {"/dev/dri/card0",
       0,
       true,
       {screen(1, {mode(800, 600, 60), mode(640, 480, 59.94), mode(640, 480, 60)})}}};
  EXPECT_THAT(complaint(cards, "", "1280x720@60"),
              AllOf(HasSubstr("HDMI-A-1 has no mode 1280x720@60 (display.mode)"),
                    HasSubstr("expected one of 800x600@60, 640x480@60")));
  EXPECT_EQ(complaint(cards, "", "640x480"), "");
}

TEST(ChooseFormat, TheBestThatIsDrawnAndShown) {
  const std::vector<std::uint32_t> drawn = {1, 2, 3};
  EXPECT_EQ(choose_format(std::vector<std::uint32_t>{3, 2, 9}, drawn), 2U);
  EXPECT_FALSE(choose_format(std::vector<std::uint32_t>{9}, drawn));
}

}  // namespace
}  // namespace lumibox::hal::kms
