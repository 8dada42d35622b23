#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>

#include "app/commands/commands.h"
#include "config/error.h"

namespace {

constexpr int kBadInput = 1;
constexpr int kBadUsage = 2;

int run(int argc, char** argv) {
  using namespace lumibox;
  CLI::App app("Lumibox: walk around something, and a light field of it is on the screen.",
               "lumibox");
  app.require_subcommand(1);
  app.set_version_flag("--version", LUMIBOX_VERSION);
  app.footer("`lumibox COMMAND --help` explains each command with an example.");
  app::add_run(app);
  app::add_demo(app);
  app::add_track(app);
  app::add_render(app);
  app::add_evaluate(app);
  app::add_import(app);
  app::add_export(app);
  app::add_sim(app);
  try {
    app.parse(argc, argv);  // runs the command named
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Results go to stdout, all that is said about the work to stderr.
  spdlog::set_default_logger(spdlog::stderr_color_mt("lumibox"));
  spdlog::set_pattern("lumibox: %^%l%$: %v");
  try {
    return run(argc, argv);
  } catch (const lumibox::config::InputError& error) {
    std::fprintf(stderr, "lumibox: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lumibox: unexpected error: %s\n", error.what());
    return kBadInput;
  }
}
