#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "appliance/box.h"
#include "lightfield/capture.h"

namespace lumibox::testing {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct Observation {
  Clock::time_point time;  // when it was asked for
  int views = 0;
};

/// Watches the capture grow for `duration`.
std::vector<Observation> watch(Box& box, milliseconds duration) {
  std::vector<Observation> seen;
  const auto end = Clock::now() + duration;
  while (Clock::now() < end) {
    const auto now = Clock::now();
    seen.push_back({now, box.views()});
    std::this_thread::sleep_for(milliseconds(100));
  }
  return seen;
}

/// Views that had been recorded a second before the power went.
int a_second_before(const std::vector<Observation>& seen, Clock::time_point cut) {
  int views = 0;
  for (const Observation& observation : seen) {
    if (observation.time < cut - std::chrono::seconds(1)) views = observation.views;
  }
  return views;
}

// Whatever it was doing when the power went: the box starts again, has all views that were recorded
// more than a second before, and records more of the same subject. The moments differ from run to
// run, as they do in a hand; which they were is written down.
TEST(PowerCut, FiveTimesInTheMiddleOfACapture) {
  Box box("power");
  box.get_devices();
  box.wait_until_ready();
  box.expect_status("aim at the subject");
  box.press(Line::Main);
  box.expect_status("the sphere is placed");
  box.press(Line::Main);
  box.expect_views(2);

  std::random_device moments;
  for (int cut = 1; cut <= 5; ++cut) {
    SCOPED_TRACE("cut " + std::to_string(cut));
    const milliseconds until_cut(2000 + moments() % 8000);
    const auto seen = watch(box, until_cut);
    box.machine().cut_power();
    const auto when = Clock::now();
    const int recorded = a_second_before(seen, when);

    const auto captures = captures_on(box.disk(), box.disk().parent_path() / "data");
    ASSERT_EQ(captures.size(), 1u);
    const auto capture = lightfield::load_capture(captures[0]);
    const int kept = static_cast<int>(capture.light_field.perspectives().size());
    note_figure("power cut after " + std::to_string(until_cut.count()) +
                " ms: " + std::to_string(recorded) + " views a second before, " +
                std::to_string(kept) + " after");
    EXPECT_GE(kept, recorded);
    EXPECT_FALSE(capture.light_field.lost_pictures()) << *capture.light_field.lost_pictures();

    box.power_up();
    box.wait_until_ready();
    EXPECT_GE(box.views(), kept);
    box.expect_status("capture");
    box.expect_views(kept + 1);
    EXPECT_EQ(box.machine().output("ls /var/lib/lumibox/captures | wc -l"), "1");
  }
}

}  // namespace
}  // namespace lumibox::testing
