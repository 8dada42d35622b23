#include "appliance/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "hal/image_io.h"

namespace lumibox::testing {
namespace {

namespace fs = std::filesystem;

/// Of the newest capture; 0 if there is none.
constexpr const char* kCountViews =
    "cat $(ls -d /var/lib/lumibox/captures/*/transforms.json 2>/dev/null | tail -n1) | "
    "grep -c file_path";

void run_here(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command + ": failed");
}

struct Partition {
  std::int64_t first_sector = 0, sectors = 0;
};

/// The third and last of the disk.
Partition data_partition(const fs::path& disk) {
  const fs::path table = disk.parent_path() / "partitions.json";
  run_here("sfdisk --json '" + disk.string() + "' >'" + table.string() + "'");
  std::ifstream stream(table);
  const auto last = nlohmann::json::parse(stream).at("partitiontable").at("partitions").at(2);
  return {last.at("start"), last.at("size")};
}

}  // namespace

fs::path image_folder() {
  const char* folder = std::getenv("LUMIBOX_APPLIANCE");
  if (folder == nullptr) {
    throw std::runtime_error(
        "LUMIBOX_APPLIANCE is not set; expected the folder of scripts/appliance");
  }
  return folder;
}

Box::Box(const std::string& name, VirtualMachine::Start start, const std::string& more_parameters)
    : disk_(image_folder() / "runs" / name / "disk.img"),
      settings_{.image = image_folder(),
                .disk = disk_,
                .scratch = disk_.parent_path(),
                .start = start,
                .more_parameters = more_parameters} {
  fs::remove_all(disk_.parent_path());
  fs::create_directories(disk_.parent_path());
  run_here("cp --sparse=always '" + (image_folder() / "lumibox.img").string() + "' '" +
           disk_.string() + "'");
  // Room for captures, as a card has it.
  fs::resize_file(disk_, 4ULL << 30);
  machine_.emplace(settings_);
}

Box::~Box() {
  machine_.reset();
  const bool failed =
      ::testing::Test::HasFailure() || ::testing::UnitTest::GetInstance()->failed_test_count() > 0;
  if (!failed) fs::remove(disk_);
}

void Box::get_devices() {
  machine_->output(
      "mkdir -p /run/tools && mount -o ro LABEL=lumibox-tools /run/tools && /run/tools/devices && "
      "cd /run/tools && cp lumibox.toml calib.txt /var/lib/lumibox");
  play(0);
  machine_->output("systemctl reset-failed; systemctl restart --no-block lumibox || true");
}

void Box::power_up() {
  machine_.reset();
  machine_.emplace(settings_);
  get_devices();
}

void Box::play(int webcam) {
  machine_->output("systemd-run --quiet --unit=webcam" + std::to_string(webcam) +
                   " /run/tools/feed /run/tools/film.yuyv 640 480 3 /dev/video2" +
                   std::to_string(webcam));
}

void Box::press(Line button, double seconds) {
  const std::string line =
      "/run/box-lines/sim_gpio" + std::to_string(static_cast<int>(button)) + "/pull";
  machine_->output("echo pull-down > " + line + "; sleep " + std::to_string(seconds) +
                   "; echo pull-up > " + line);
}

bool Box::lamp_is_lit() {
  const int line = static_cast<int>(Line::Lamp);
  return machine_->output("cat /run/box-lines/sim_gpio" + std::to_string(line) + "/value") == "1";
}

void Box::wait_until_ready() {
  if (!machine_->becomes_true("systemctl is-active --quiet lumibox")) {
    throw std::runtime_error("the box does not become ready; its log:\n" +
                             machine_->run("journalctl -b -u lumibox --no-pager -o cat").output);
  }
}

std::string Box::status() {
  return machine_->output("systemctl show --property=StatusText --value lumibox");
}

void Box::expect_status(const std::string& words) {
  if (!machine_->becomes_true("systemctl show --property=StatusText lumibox | grep -qF '" + words +
                              "'")) {
    ADD_FAILURE() << "the status does not come to say '" << words << "', but '" << status()
                  << "'; the log:\n"
                  << machine_->run("journalctl -b -u lumibox --no-pager -o cat").output;
  }
}

int Box::views() {
  return std::stoi(machine_->run(kCountViews).output);
}

void Box::expect_views(int at_least) {
  EXPECT_TRUE(machine_->becomes_true("[ $(" + std::string(kCountViews) + ") -ge " +
                                     std::to_string(at_least) + " ]"))
      << "there are " << views() << " views; status: " << status();
}

bool Box::comes_to_show(const std::function<bool(const hal::Image&)>& is_it) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_it(machine_->screen())) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  return true;
}

hal::Image Box::look(const std::string& name) {
  hal::Image screen = machine_->screen();
  const fs::path screens = image_folder() / "screens";
  fs::create_directories(screens);
  hal::write_png(screens / (name + ".png"), screen);
  return screen;
}

std::int64_t data_partition_bytes(const fs::path& disk) {
  return 512 * data_partition(disk).sectors;
}

std::vector<fs::path> captures_on(const fs::path& disk, const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string data = (folder / "data.img").string();
  const Partition partition = data_partition(disk);
  run_here("dd if='" + disk.string() + "' of='" + data + "' bs=512 conv=sparse status=none skip=" +
           std::to_string(partition.first_sector) + " count=" + std::to_string(partition.sectors));
  // e2fsck's status 1: mended, as it has to after a power cut.
  run_here("e2fsck -fp '" + data + "' >'" + data + ".log' || [ $? -eq 1 ]");
  run_here("debugfs -R 'rdump /captures " + folder.string() + "' '" + data + "' 2>>'" + data +
           ".log'");
  fs::remove(data);
  std::vector<fs::path> captures;
  for (const auto& entry : fs::directory_iterator(folder / "captures")) {
    captures.push_back(entry.path());
  }
  std::sort(captures.begin(), captures.end());
  return captures;
}

void note_figure(const std::string& line) {
  std::printf("figure: %s\n", line.c_str());
  std::FILE* file = std::fopen((image_folder() / "figures.txt").c_str(), "a");
  if (file == nullptr) throw std::runtime_error("figures.txt: cannot be written");
  std::fprintf(file, "%s\n", line.c_str());
  std::fclose(file);
}

}  // namespace lumibox::testing
