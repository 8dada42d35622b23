#include "hal/debouncer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace lumibox::hal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kQuiet = 10 * kMs;

/// What the kernel keeps of a line between two readings.
constexpr std::size_t kKept = 16;

TEST(Debouncer, ToldOnceQuietForLongEnoughWithTheTimeOfTheFirstContact) {
  Debouncer debouncer(kQuiet, false);
  EXPECT_THAT(debouncer.update({{{true, 1 * kMs}, {false, 2 * kMs}, {true, 3 * kMs}}, true, false},
                               4 * kMs),
              IsEmpty());
  EXPECT_FALSE(debouncer.active());
  EXPECT_THAT(debouncer.update({{}, true, false}, 13 * kMs - 1), IsEmpty());
  EXPECT_THAT(debouncer.update({{}, true, false}, 13 * kMs), ElementsAre(LineEdge{true, 1 * kMs}));
  EXPECT_TRUE(debouncer.active());
  EXPECT_THAT(debouncer.update({{}, true, false}, 500 * kMs), IsEmpty());
}

TEST(Debouncer, ADisturbanceIsNotTold) {
  Debouncer debouncer(kQuiet, false);
  EXPECT_THAT(debouncer.update({{{true, 1 * kMs}, {false, 2 * kMs}}, false, false}, 100 * kMs),
              IsEmpty());
}

TEST(Debouncer, ASlowLoopGetsPressAndReleaseAtOnce) {
  Debouncer debouncer(kQuiet, false);
  EXPECT_THAT(debouncer.update({{{true, 1 * kMs}, {false, 300 * kMs}}, false, false}, 999 * kMs),
              ElementsAre(LineEdge{true, 1 * kMs}, LineEdge{false, 300 * kMs}));
}

// The level is read after the edges, and may be ahead of them: the edge comes with the next
// reading.
TEST(Debouncer, AnEdgeBetweenTwoReadingsKeepsItsOwnTime) {
  Debouncer debouncer(kQuiet, false);
  EXPECT_THAT(debouncer.update({{}, true, false}, 33 * kMs), IsEmpty());
  EXPECT_THAT(debouncer.update({{{true, 33 * kMs - 5}}, true, false}, 66 * kMs),
              ElementsAre(LineEdge{true, 33 * kMs - 5}));
}

// The kernel said that the line fell, then kept no more of a long burst that ended high.
TEST(Debouncer, WhereEdgesWereLostTheLevelTellsAndTheBurstKeepsItsTime) {
  Debouncer debouncer(kQuiet, false);
  LineReading reading{{}, true, true};
  for (std::size_t i = 0; i < kKept; ++i) {
    reading.edges.push_back({i % 2 == 0, static_cast<std::int64_t>(i) * kMs / 10});
  }
  EXPECT_THAT(debouncer.update(reading, 33 * kMs), IsEmpty());
  EXPECT_THAT(debouncer.update({{}, true, false}, 66 * kMs), ElementsAre(LineEdge{true, 0}));
}

// Nothing was said to be lost, and the press before had long settled when the line changed again.
TEST(Debouncer, ALevelThatChangedJustNowDoesNotUndoWhatWasCertain) {
  Debouncer debouncer(kQuiet, false);
  EXPECT_THAT(debouncer.update({{{true, 1 * kMs}}, false, false}, 33 * kMs),
              ElementsAre(LineEdge{true, 1 * kMs}));
  EXPECT_THAT(debouncer.update({{}, false, false}, 66 * kMs),
              ElementsAre(LineEdge{false, 33 * kMs}));
}

TEST(Debouncer, BeginsWithTheLevelItIsGiven) {
  Debouncer debouncer(kQuiet, true);
  EXPECT_THAT(debouncer.update({{}, true, false}, 100 * kMs), IsEmpty());
  EXPECT_THAT(debouncer.update({{{false, 110 * kMs}}, false, false}, 120 * kMs),
              ElementsAre(LineEdge{false, 110 * kMs}));
}

TEST(Debouncer, WithoutAnyQuietEveryEdgeIsTold) {
  Debouncer debouncer(0, false);
  EXPECT_THAT(debouncer.update({{{true, 1}, {false, 2}, {true, 3}}, true, false}, 3),
              ElementsAre(LineEdge{true, 1}, LineEdge{false, 2}, LineEdge{true, 3}));
}

/// Presses and releases of a finger and the edges that a bad switch makes of them.
struct Pressing {
  std::vector<LineEdge> meant;
  std::vector<LineEdge> edges;
};

/// Edges that are up to `most_bounces` each, all within less than the quiet time, and as far apart
/// as fingers are.
Pressing pressing(int most_bounces) {
  Pressing made;
  std::int64_t at_ns = 0;
  const int presses = *rc::gen::inRange(1, 5);
  for (int i = 0; i < 2 * presses; ++i) {
    const bool active = i % 2 == 0;
    at_ns += *rc::gen::inRange<std::int64_t>(3 * kQuiet, 60 * kQuiet);
    made.meant.push_back({active, at_ns});
    const int bounces = *rc::gen::inRange(0, most_bounces + 1);
    std::vector<std::int64_t> times = {0};
    for (int b = 0; b < 2 * bounces; ++b) {
      times.push_back(*rc::gen::inRange<std::int64_t>(1, kQuiet));
    }
    std::ranges::sort(times);
    for (std::size_t t = 0; t < times.size(); ++t) {
      made.edges.push_back({t % 2 == 0 ? active : !active, at_ns + times[t]});
    }
  }
  return made;
}

/// What is told when the edges are read in ticks of a loop; of a tick's edges the kernel keeps so
/// many, the oldest or the newest.
std::vector<LineEdge> told(const std::vector<LineEdge>& edges, std::size_t kept, bool oldest,
                           std::int64_t longest_tick_ns) {
  Debouncer debouncer(kQuiet, false);
  std::vector<LineEdge> all;
  std::size_t next = 0;
  bool level = false;
  const std::int64_t end_ns = edges.back().timestamp_ns + 2 * kQuiet + longest_tick_ns;
  for (std::int64_t now_ns = 0; now_ns < end_ns;) {
    now_ns += *rc::gen::inRange<std::int64_t>(1 * kMs, longest_tick_ns);
    LineReading reading;
    for (; next < edges.size() && edges[next].timestamp_ns <= now_ns; ++next) {
      reading.edges.push_back(edges[next]);
      level = edges[next].active;
    }
    if (reading.edges.size() > kept) {
      const auto excess = static_cast<std::ptrdiff_t>(reading.edges.size() - kept);
      if (oldest) {
        reading.edges.resize(kept);
        reading.lost = true;
      } else {
        reading.edges.erase(reading.edges.begin(), reading.edges.begin() + excess);
      }
    }
    reading.active = level;
    for (const LineEdge& edge : debouncer.update(reading, now_ns)) all.push_back(edge);
  }
  return all;
}

RC_GTEST_PROP(Debouncer, HoweverASwitchBouncesEachPressIsToldOnceWithItsTime, ()) {
  const Pressing made = pressing(20);
  RC_ASSERT(told(made.edges, 1000, true, 100 * kMs) == made.meant);
}

// Ticks no longer than the pause between edges: what the kernel loses is of one burst. The first
// interface loses the newest edges, and the first of a burst is never among them.
RC_GTEST_PROP(Debouncer, LostEdgesLoseNoPress, ()) {
  const Pressing made = pressing(40);
  RC_ASSERT(told(made.edges, kKept, true, 2 * kQuiet) == made.meant);
}

// The second interface loses the oldest, and a press may be told to be as much later as it bounced.
RC_GTEST_PROP(Debouncer, LostOldEdgesLoseNoPressEither, ()) {
  const Pressing made = pressing(40);
  const std::vector<LineEdge> all = told(made.edges, kKept, false, 2 * kQuiet);
  RC_ASSERT(all.size() == made.meant.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    RC_ASSERT(all[i].active == made.meant[i].active);
    RC_ASSERT(all[i].timestamp_ns >= made.meant[i].timestamp_ns);
    RC_ASSERT(all[i].timestamp_ns < made.meant[i].timestamp_ns + kQuiet);
  }
}

// Whatever the line does and whatever is lost of it, what is told alternates, goes forward in time
// and ends with the truth.
RC_GTEST_PROP(Debouncer, NoiseNeverMakesEdgesThatMakeNoSense, ()) {
  const auto times = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, 300 * kMs)));
  std::vector<std::int64_t> sorted = times;
  std::ranges::sort(sorted);
  std::vector<LineEdge> edges;
  for (const std::int64_t time_ns : sorted) {
    edges.push_back({*rc::gen::arbitrary<bool>(), time_ns});
  }
  const std::vector<LineEdge> all =
      told(edges, kKept, *rc::gen::arbitrary<bool>(), *rc::gen::inRange(2 * kMs, 200 * kMs));
  for (std::size_t i = 0; i < all.size(); ++i) {
    RC_ASSERT(all[i].active == (i % 2 == 0));
    RC_ASSERT(i == 0 || all[i].timestamp_ns >= all[i - 1].timestamp_ns);
  }
  RC_ASSERT((all.size() % 2 == 1) == edges.back().active);
}

}  // namespace
}  // namespace lumibox::hal
