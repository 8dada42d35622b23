#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "appliance/box.h"

namespace lumibox::testing {
namespace {

/// Seconds from the kernel's start until the unit was active.
double active_s(VirtualMachine& machine, const std::string& unit) {
  const std::string text =
      machine.output("systemctl show --property=ActiveEnterTimestampMonotonic --value " + unit);
  if (text.empty()) throw std::runtime_error("no time at which " + unit + " was active");
  return 1e-6 * std::stod(text);
}

/// How exposed the service is, as the service manager judges what its unit forbids.
double exposure(VirtualMachine& machine) {
  const std::string text = machine.output("systemd-analyze security --no-pager lumibox | tail -n1");
  std::smatch number;
  return std::regex_search(text, number, std::regex("[0-9]+\\.[0-9]")) ? std::stod(number[0])
                                                                       : 10.0;
}

/// The box's writing in white at the top left, and nothing so white elsewhere: neither the picture
/// of the firmware nor a console.
bool shows_only_the_status(const hal::Image& screen) {
  int status = 0, elsewhere = 0;
  for (int y = 0; y < screen.height(); ++y) {
    for (int x = 0; x < screen.width(); ++x) {
      const auto* rgb = screen.at(x, y);
      if (std::min({rgb[0], rgb[1], rgb[2]}) > 200) ++(y < 40 ? status : elsewhere);
    }
  }
  return status > 100 && elsewhere == 0;
}

// What a medium does that the image was written to: it is larger than the image.
TEST(Boot, FromTheFirmwareWithoutAWebcam) {
  Box box("firmware", VirtualMachine::Start::Firmware);
  EXPECT_TRUE(box.comes_to_show(shows_only_the_status));
  box.look("boot-1-from-the-firmware");
  ASSERT_TRUE(box.machine().shut_down());
  EXPECT_GT(data_partition_bytes(box.disk()), std::int64_t{1} << 30) << "it has not grown";
}

TEST(Boot, TimesAndExposure) {
  {
    Box bare("bare", VirtualMachine::Start::Kernel, "systemd.mask=lumibox.service");
    ASSERT_TRUE(bare.machine().becomes_true("systemctl is-active --quiet multi-user.target"));
    note_figure("kernel to all services, without the box: " +
                std::to_string(active_s(bare.machine(), "multi-user.target")) + " s");
  }
  Box box("boot");
  box.wait_until_ready();
  ASSERT_TRUE(box.machine().becomes_true("systemctl is-active --quiet multi-user.target"));
  note_figure("kernel to the first picture of the box: " +
              std::to_string(active_s(box.machine(), "lumibox")) + " s");
  note_figure("systemd-analyze blame:\n" +
              box.machine().output("systemd-analyze blame --no-pager | head -n 12"));
  const double exposed = exposure(box.machine());
  note_figure("systemd-analyze security: " + std::to_string(exposed));
  EXPECT_LE(exposed, 2.0);
  EXPECT_EQ(box.machine().output("systemctl --failed --plain --no-legend"), "");
}

}  // namespace
}  // namespace lumibox::testing
