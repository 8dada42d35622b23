#include "app/demo.h"

#include <cstdio>

#include "app/commands/commands.h"

namespace lumibox::app {
namespace {

struct DemoOptions {
  config::Sources sources;
  std::filesystem::path out = "lumibox-demo";
  double rate_hz = 15.0;
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
  command
      ->add_option("--rate", options->rate_hz,
                   "ticks per simulated second; the camera has 30, and fewer are over sooner")
      ->type_name("HZ")
      ->check(CLI::Range(5.0, 60.0))
      ->capture_default_str();
  command->callback([options] {
    make_folder(options->out);
    config::Config config = load_config(options->sources);
    config.loop.rate_hz = options->rate_hz;
    run_demo(config, options->out);
    std::printf("see %s\n", options->out.c_str());
  });
}

}  // namespace lumibox::app
