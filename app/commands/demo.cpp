#include "app/demo.h"

#include <cstdio>

#include "app/commands/commands.h"

namespace lumibox::app {
namespace {

struct DemoOptions {
  config::Sources sources;
  std::filesystem::path out = "lumibox-demo";
};

}  // namespace

void add_demo(CLI::App& app) {
  auto options = std::make_shared<DemoOptions>();
  CLI::App* command = add_command(
      app, "demo", "A simulated box from the first picture to the review, without any hardware.",
      "lumibox demo --out out/demo", options->sources);
  command->add_option("--out", options->out, "folder for the pictures and the capture")
      ->type_name("DIR")
      ->capture_default_str();
  command->callback([options] {
    make_folder(options->out);
    run_demo(load_config(options->sources), options->out);
    std::printf("see %s\n", options->out.c_str());
  });
}

}  // namespace lumibox::app
