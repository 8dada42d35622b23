#include "appliance/virtual_machine.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "hal/image_io.h"

namespace lumibox::testing {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::string all = text.str();
  while (!all.empty() && all.back() == '\n') all.pop_back();
  return all;
}

std::vector<std::string> command_line(const VirtualMachine::Settings& settings) {
  const auto drive = [](const fs::path& file, const std::string& more) {
    return "file=" + file.string() + ",format=raw,if=virtio," + more;
  };
  // What the guest has brought to its disk is on ours, whatever becomes of QEMU.
  std::vector<std::string> line = {
      "qemu-system-x86_64",
      "-machine",
      "q35",
      "-accel",
      "tcg,thread=multi",
      "-smp",
      "2",
      "-m",
      "2048",
      "-cpu",
      "qemu64",
      "-nodefaults",
      "-display",
      "none",
      "-device",
      "virtio-gpu-pci,xres=640,yres=480",
      "-device",
      "virtio-keyboard-pci",
      "-device",
      "virtio-rng-pci",
      "-drive",
      drive(settings.disk, "cache=writethrough"),
      "-serial",
      "file:" + (settings.scratch / "console.log").string(),
      "-serial",
      "unix:" + (settings.scratch / "shell").string() + ",server=on,wait=off",
      "-qmp",
      "unix:" + (settings.scratch / "qmp").string() + ",server=on,wait=off"};
  if (settings.start == VirtualMachine::Start::Firmware) {
    line.insert(line.end(), {"-bios", "/usr/share/ovmf/OVMF.fd"});
    return line;
  }
  const std::string parameters = content(settings.image / "cmdline") +
                                 " console=ttyS0 systemd.debug_shell=ttyS1 "
                                 "systemd.journald.forward_to_console=1 " +
                                 settings.more_parameters;
  line.insert(line.end(), {"-drive", drive(settings.image / "tools.img", "readonly=on"), "-kernel",
                           settings.image / "vmlinux", "-initrd", settings.image / "initrd.img",
                           "-append", parameters});
  return line;
}

pid_t start(const std::vector<std::string>& line, const fs::path& log) {
  std::vector<char*> arguments;
  for (const std::string& argument : line) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("no process for QEMU");
  if (process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves no machine behind
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  return process;
}

}  // namespace

VirtualMachine::VirtualMachine(const Settings& settings) : settings_(settings) {
  fs::create_directories(settings.scratch);
  for (const char* socket : {"shell", "qmp"}) fs::remove(settings.scratch / socket);
  process_ = start(command_line(settings), settings.scratch / "qemu.log");
  try {
    qmp_ = connect("qmp");
    qmp_->read_line();  // it introduces itself
    ask_qemu("qmp_capabilities");
    if (settings.start == Start::Kernel) open_shell();
  } catch (...) {
    cut_power();
    throw;
  }
}

VirtualMachine::~VirtualMachine() {
  cut_power();
}

std::unique_ptr<LineSocket> VirtualMachine::connect(const char* name) {
  return std::make_unique<LineSocket>(settings_.scratch / name, [this] { return !off(WNOHANG); });
}

/// Until the shell is there nobody listens at the serial line, and what is said is lost or comes
/// late.
void VirtualMachine::open_shell() {
  shell_ = connect("shell");
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (int i = 0;; ++i) {
    const std::string word = "shell-" + std::to_string(i) + "-is-open";
    // Typed so that its echo differs from its answer.
    shell_->write("stty -echo; PS1= PS2= exec dash; \necho " + word.substr(0, 5) + "''" +
                  word.substr(5) + "\n");
    try {
      while (shell_->read_line(std::chrono::seconds(5)).find(word) == std::string::npos) {
      }
      return;
    } catch (const std::runtime_error&) {
      if (std::chrono::steady_clock::now() > end || off(WNOHANG)) throw;
    }
  }
}

CommandResult VirtualMachine::run(const std::string& command) {
  const std::string end = "@@" + std::to_string(++commands_) + " ";
  shell_->write("{ " + command + "\n} </dev/null 2>&1; status=$?; echo; echo \"" + end +
                "$status\"\n");
  CommandResult result;
  for (;;) {
    const std::string line = shell_->read_line();
    if (line.rfind(end, 0) == 0) {
      result.status = std::stoi(line.substr(end.size()));
      result.output.resize(result.output.size() - std::min<std::size_t>(result.output.size(), 1));
      return result;
    }
    result.output += line + "\n";
  }
}

std::string VirtualMachine::output(const std::string& command) {
  CommandResult result = run(command);
  if (result.status != 0) {
    throw std::runtime_error("in the guest, '" + command + "' ended with " +
                             std::to_string(result.status) + ":\n" + result.output);
  }
  while (!result.output.empty() && result.output.back() == '\n') result.output.pop_back();
  return result.output;
}

bool VirtualMachine::becomes_true(const std::string& command, std::chrono::seconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (run(command).status != 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return true;
}

std::string VirtualMachine::ask_qemu(const std::string& command, const std::string& arguments) {
  qmp_->write(R"({"execute":")" + command + R"(","arguments":)" + arguments + "}\n");
  for (;;) {
    const auto answer = nlohmann::json::parse(qmp_->read_line());
    if (answer.contains("return")) return answer["return"].dump();
    if (answer.contains("error")) throw std::runtime_error(command + ": " + answer["error"].dump());
  }
}

hal::Image VirtualMachine::screen() {
  const fs::path file = settings_.scratch / "screen.png";
  ask_qemu("screendump", nlohmann::json{{"filename", file}, {"format", "png"}}.dump());
  return hal::to_rgb(hal::read_image(file));
}

void VirtualMachine::type(const std::string& keys) {
  nlohmann::json names = nlohmann::json::array();
  std::istringstream stream(keys);
  for (std::string key; std::getline(stream, key, '-');) {
    names.push_back({{"type", "qcode"}, {"data", key}});
  }
  ask_qemu("send-key", nlohmann::json{{"keys", names}}.dump());
}

bool VirtualMachine::off(int options) {
  if (process_ > 0 && ::waitpid(process_, nullptr, options) == process_) process_ = -1;
  return process_ < 0;
}

bool VirtualMachine::shut_down() {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (int i = 0; !off(WNOHANG); ++i) {
    if (std::chrono::steady_clock::now() > end) return false;
    // Again and again: a system that is only starting does not hear it.
    if (i % 100 == 0) ask_qemu("system_powerdown");
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

void VirtualMachine::cut_power() {
  if (process_ > 0) ::kill(process_, SIGKILL);
  off(0);
}

}  // namespace lumibox::testing
