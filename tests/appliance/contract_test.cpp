#include <gtest/gtest.h>

#include "appliance/box.h"

// What every camera and every set of buttons has to do (tests/hal/*_contract_test.cpp), on those of
// a real kernel: v4l2loopback and two test cameras of the kernel's own, gpio-sim and uinput.
namespace lumibox::testing {
namespace {

class Contracts : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    box_ = std::make_unique<Box>("contracts");
    guest().output("systemctl mask --runtime --now lumibox");
    box_->get_devices();
  }
  static void TearDownTestSuite() { box_.reset(); }
  static Box& box() { return *box_; }
  static VirtualMachine& guest() { return box_->machine(); }

  /// The tests of that program that `filter` names pass, and there are some that were not skipped.
  static void expect_pass(const std::string& environment, const std::string& program,
                          const std::string& filter) {
    const CommandResult result =
        guest().run("cd /tmp && " + environment + " /run/tools/" + program +
                    " --gtest_color=no --gtest_brief=1 --gtest_filter='" + filter + "'");
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("[  PASSED  ]"), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find("] 0 tests"), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find("SKIPPED"), std::string::npos) << result.output;
    const std::size_t summary = std::min(result.output.rfind("[  P"), result.output.size());
    note_figure("contract, " + environment + " " + filter + ": " +
                result.output.substr(summary, 23));
  }

 private:
  static std::unique_ptr<Box> box_;
};
std::unique_ptr<Box> Contracts::box_;

TEST_F(Contracts, CameraOfV4l2loopback) {
  expect_pass("LUMIBOX_TEST_VIDEO=/dev/video20", "camera_contract_test", "*RealVideo");
}

TEST_F(Contracts, CameraOfVivid) {
  guest().output(
      "modprobe vivid n_devs=1 node_types=0x1 input_types=0 vid_cap_nr=30 && udevadm settle");
  expect_pass("LUMIBOX_TEST_VIDEO=/dev/video30", "camera_contract_test", "*RealVideo");
}

TEST_F(Contracts, CameraOfLibcamera) {
  guest().output(
      "modprobe -a v4l2-tpg videobuf2-vmalloc videobuf2-dma-contig && "
      "insmod /run/tools/vimc.ko && udevadm settle");
  expect_pass("LUMIBOX_TEST_LIBCAMERA=auto", "camera_contract_test", "*RealLibcamera");
}

TEST_F(Contracts, ButtonsOfGpioSim) {
  expect_pass("", "buttons_contract_test", "*GpioSim*");
}

TEST_F(Contracts, ButtonsOfUinput) {
  guest().output("modprobe uinput");
  expect_pass("", "buttons_contract_test", "*Uinput*");
}

}  // namespace
}  // namespace lumibox::testing
