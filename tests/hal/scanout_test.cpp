// Pictures on their way to a screen that is unplugged, taken away and slow.

#include "hal/kms/scanout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "config/log.h"
#include "hal/fake_card.h"

namespace lumibox::hal::kms {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class ScanoutTest : public ::testing::Test {
 protected:
  ScanoutTest() {
    config::set_log_level("info");
    card_.plugged = {screen(1, {mode(640, 480, 60)})};
  }

  void show(int pictures) {
    for (int i = 0; i < pictures; ++i) scanout_.present();
  }
  void wait(std::int64_t time_ns) { clock_.wait_until(clock_.now_ns() + time_ns); }
  void unplug() {
    card_.plugged[0].connected = false;
    card_.plugged[0].modes.clear();
  }

  VirtualClock clock_;
  FakeCard card_{clock_};
  FakeTerminal terminal_;
  FakeBuffers buffers_;
  Scanout scanout_{card_,
                   &terminal_,
                   buffers_,
                   clock_,
                   parse_mode_wish("640x480"),
                   Output{{101, 1}, "HDMI-A-1", mode(640, 480, 60)}};
};

TEST_F(ScanoutTest, TheFirstPictureSwitchesTheScreenOn) {
  EXPECT_EQ(scanout_.presented(), 0);
  show(1);
  ASSERT_EQ(card_.modes_set.size(), 1U);
  EXPECT_EQ(card_.last_pipe.crtc, 101U);
  EXPECT_EQ(card_.on_screen(), 1U);
  EXPECT_EQ(scanout_.presented(), 1);
}

TEST_F(ScanoutTest, LaterPicturesAreFlippedToOncePerVerticalBlank) {
  show(1);
  const std::int64_t begin_ns = clock_.now_ns();
  show(6);  // the first is only submitted, and the last not waited for
  EXPECT_EQ(card_.modes_set.size(), 1U);
  EXPECT_EQ(clock_.now_ns() - begin_ns, 5 * card_.frame_ns);
  EXPECT_THAT(card_.shown, ElementsAre(1, 2, 3, 1, 2, 3));
  EXPECT_EQ(card_.pending(), 1U);
  EXPECT_EQ(scanout_.presented(), 6);
}

TEST_F(ScanoutTest, WithoutVerticalBlankNothingWaits) {
  card_.frame_ns = 0;
  show(100);
  EXPECT_EQ(clock_.now_ns(), 0);
  EXPECT_EQ(scanout_.presented(), 99) << "the last is under way";
}

TEST_F(ScanoutTest, AFlipThatDoesNotEndIsWaitedForOnceOnly) {
  show(2);
  card_.hangs = true;
  const std::int64_t presented = scanout_.presented();
  show(1);
  EXPECT_EQ(clock_.now_ns(), kSecond_ns);
  show(50);
  EXPECT_EQ(clock_.now_ns(), kSecond_ns);
  EXPECT_EQ(scanout_.presented(), presented) << "a watchdog must see this";
}

TEST_F(ScanoutTest, WhatIsWrongIsSaidOnce) {
  show(2);
  card_.hangs = true;
  card_.end_flip_in_silence();
  ::testing::internal::CaptureStdout();
  show(1);
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, ::testing::HasSubstr("a page flip does not end"));
  ::testing::internal::CaptureStdout();
  for (int i = 0; i < 5; ++i) {
    card_.end_flip_in_silence();
    show(1);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST_F(ScanoutTest, AnEndThatNobodyReportedIsNoticedByTheNextFlip) {
  show(2);
  card_.hangs = true;
  card_.end_flip_in_silence();
  show(3);  // flips are taken, since the card is free
  EXPECT_EQ(clock_.now_ns(), kSecond_ns) << "waited once";
  EXPECT_TRUE(buffers_.locked.size() <= 2U);
  card_.hangs = false;
  const std::int64_t presented = scanout_.presented();
  wait(2 * kSecond_ns);  // the card that said "under way" is tried again
  show(3);
  EXPECT_GT(scanout_.presented(), presented);
}

TEST_F(ScanoutTest, EndsOfFlipsBeforeTheModeWasSetAreNotTakenForLaterOnes) {
  show(2);
  card_.stray = {77};
  show(1);
  EXPECT_THAT(card_.shown, ElementsAre(1, 2));
  EXPECT_EQ(card_.pending(), 3U);
}

TEST_F(ScanoutTest, UnpluggedPicturesAreDroppedAndTheBoxGoesOn) {
  show(3);
  unplug();
  wait(kSecond_ns);
  show(1);
  EXPECT_FALSE(scanout_.showing());
  const std::size_t shown = card_.shown.size();
  const std::int64_t before_ns = clock_.now_ns();
  const std::int64_t presented = scanout_.presented();
  show(50);
  EXPECT_EQ(clock_.now_ns(), before_ns) << "nothing waits for a screen that is not there";
  EXPECT_EQ(card_.shown.size(), shown);
  EXPECT_EQ(scanout_.presented(), presented + 50) << "nobody is to be restarted for that";
}

TEST_F(ScanoutTest, LooksOncePerSecondAndProbesOnlyWhatIsPluggedIn) {
  show(2);
  unplug();
  wait(kSecond_ns);
  show(1);
  card_.plugged = {screen(1, {mode(640, 480, 60)})};
  show(10);
  EXPECT_EQ(card_.probes, 0);
  EXPECT_FALSE(scanout_.showing());
  wait(kSecond_ns);
  show(1);
  EXPECT_EQ(card_.probes, 1);
  EXPECT_TRUE(scanout_.showing());
  EXPECT_EQ(card_.modes_set.size(), 2U) << "the screen is switched on again";
}

TEST_F(ScanoutTest, AnotherScreenGetsItsOwnModeAndOtherBuffers) {
  show(3);
  unplug();
  wait(kSecond_ns);
  show(1);
  card_.plugged.push_back(screen(2, {mode(1920, 1080, 60, true), mode(800, 600, 60)}));
  wait(kSecond_ns);
  show(1);
  EXPECT_EQ(scanout_.size(), (Size{1920, 1080}));
  EXPECT_EQ(buffers_.size, (Size{1920, 1080}));
  EXPECT_EQ(card_.modes_set.size(), 1U) << "what was drawn for the old size is not shown";
  show(2);
  EXPECT_EQ(card_.modes_set.back().size, (Size{1920, 1080}));
  EXPECT_EQ(card_.last_pipe.connector, 2U);
  EXPECT_EQ(card_.on_screen(), 11U);
  EXPECT_EQ(card_.pending(), 12U);
}

TEST_F(ScanoutTest, AnotherProgramTakesTheCardAndGivesItBack) {
  show(3);
  card_.take_away();
  show(1);
  EXPECT_FALSE(scanout_.showing());
  show(20);
  EXPECT_EQ(card_.tries, 0);
  wait(kSecond_ns);
  show(20);
  EXPECT_EQ(card_.tries, 1) << "once a second";
  EXPECT_FALSE(scanout_.showing());
  card_.taken = false;
  wait(kSecond_ns);
  show(1);
  EXPECT_TRUE(scanout_.showing());
  EXPECT_EQ(card_.modes_set.size(), 2U);
  show(5);
  EXPECT_EQ(card_.modes_set.size(), 2U);
}

TEST_F(ScanoutTest, AConsoleSwitchGivesTheCardAwayAndTakesItBackAtOnce) {
  show(3);
  terminal_.request = Terminal::Request::Leave;
  show(1);
  EXPECT_FALSE(card_.is_master);
  EXPECT_THAT(terminal_.said, ElementsAre("let go"));
  EXPECT_EQ(card_.pending(), std::nullopt) << "what was under way ended before";
  wait(5 * kSecond_ns);
  show(5);
  EXPECT_EQ(card_.tries, 0) << "the other console keeps the screen";
  terminal_.request = Terminal::Request::Return;
  show(1);
  EXPECT_THAT(terminal_.said, ElementsAre("let go", "take back"));
  EXPECT_TRUE(scanout_.showing());
  EXPECT_EQ(card_.modes_set.size(), 2U);
}

TEST_F(ScanoutTest, AScreenThatTakesNoPictureIsTriedAgain) {
  show(2);
  card_.refuses = true;
  show(1);
  EXPECT_FALSE(scanout_.showing());
  wait(kSecond_ns);
  show(1);
  card_.refuses = false;
  wait(kSecond_ns);
  show(1);
  EXPECT_TRUE(scanout_.showing());
  EXPECT_EQ(buffers_.locked.size(), 1U);
}

TEST_F(ScanoutTest, APictureLostWithItsContextIsNotShownAndDoesNotCount) {
  show(2);
  const std::int64_t presented = scanout_.presented();
  buffers_.lost = true;
  show(3);
  EXPECT_EQ(card_.shown.size(), 1U);
  EXPECT_EQ(scanout_.presented(), presented);
  buffers_.lost = false;
  show(2);
  EXPECT_GT(scanout_.presented(), presented);
}

// Whatever happens in whatever order, no buffer on the screen is drawn into, none is lost, and
// pictures come back once all is well.
RC_GTEST_PROP(ScanoutProperty, NoBufferIsEverLostOrShownWhileDrawn, ()) {
  config::set_log_level("off");
  VirtualClock clock;
  FakeCard card(clock);
  card.plugged = {screen(1, {mode(640, 480, 60)})};
  FakeTerminal terminal;
  FakeBuffers buffers;
  Scanout scanout(card, &terminal, buffers, clock, std::nullopt,
                  Output{{101, 1}, "HDMI-A-1", mode(640, 480, 60)});
  bool away = false;
  for (const int event : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 9))) {
    if (event == 0) card.plugged[0].connected = false;
    if (event == 1) card.plugged = {screen(1, {mode(640, 480, 60)})};
    if (event == 2) card.plugged = {screen(2, {mode(800, 600, 60)})};
    if (event == 3) card.take_away();
    if (event == 4) card.taken = false;
    if (event == 5) card.hangs = !card.hangs;
    if (event == 6) clock.wait_until(clock.now_ns() + kSecond_ns);
    if (event == 7) {
      terminal.request = away ? Terminal::Request::Return : Terminal::Request::Leave;
      away = !away;
    }
    scanout.present();
    if (scanout.showing() && card.is_master && card.on_screen() >= buffers.first) {
      RC_ASSERT(buffers.locked.contains(card.on_screen()));
    }
    RC_ASSERT(buffers.locked.size() <= 3U);
  }
  card.plugged = {screen(1, {mode(640, 480, 60)})};
  card.taken = false;
  card.hangs = false;
  if (away) terminal.request = Terminal::Request::Return;
  for (int i = 0; i < 5; ++i) {
    clock.wait_until(clock.now_ns() + kSecond_ns);
    scanout.present();
    scanout.present();
  }
  const std::int64_t presented = scanout.presented();
  scanout.present();
  RC_ASSERT(scanout.showing());
  RC_ASSERT(scanout.presented() == presented + 1);
}

}  // namespace
}  // namespace lumibox::hal::kms
