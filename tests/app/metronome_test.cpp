#include "app/metronome.h"

#include <gtest/gtest.h>

#include "hal/sim/virtual_clock.h"

namespace lumibox::app {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Metronome, KeepsTheRateWhateverShareOfTheTickTheWorkTakes) {
  hal::VirtualClock clock;
  Metronome metronome(clock, 100.0);
  for (int tick = 1; tick <= 50; ++tick) {
    clock.wait_until(clock.now_ns() + (tick % 10) * kMs);
    metronome.wait();
    EXPECT_EQ(clock.now_ns(), tick * 10 * kMs);
  }
  EXPECT_EQ(metronome.late_ticks(), 0);
}

TEST(Metronome, AfterALateTickTheNextBeginsAtOnceAndNothingIsReplayed) {
  hal::VirtualClock clock;
  Metronome metronome(clock, 100.0);
  clock.wait_until(57 * kMs);  // five and a half periods
  metronome.wait();
  EXPECT_EQ(clock.now_ns(), 57 * kMs);
  EXPECT_EQ(metronome.late_ticks(), 1);
  metronome.wait();
  EXPECT_EQ(clock.now_ns(), 67 * kMs);
  metronome.wait();
  EXPECT_EQ(clock.now_ns(), 77 * kMs);
  EXPECT_EQ(metronome.late_ticks(), 1);
}

TEST(Metronome, WorkThatAlwaysTakesLongerIsCountedEachTime) {
  hal::VirtualClock clock;
  Metronome metronome(clock, 100.0);
  for (int tick = 1; tick <= 5; ++tick) {
    clock.wait_until(clock.now_ns() + 12 * kMs);
    metronome.wait();
    EXPECT_EQ(clock.now_ns(), tick * 12 * kMs);
  }
  EXPECT_EQ(metronome.late_ticks(), 5);
}

}  // namespace
}  // namespace lumibox::app
