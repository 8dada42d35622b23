#include <cstdio>

#include "app/commands/commands.h"
#include "app/progress.h"
#include "hal/sim/scene.h"

namespace lumibox::app {
namespace {

struct SimOptions {
  config::Sources sources;
  std::filesystem::path scene;
  std::filesystem::path out;
};

void simulate(const SimOptions& options) {
  load_config(options.sources);
  refuse_used_folder(options.out);
  const auto scene = hal::load_scene(options.scene);
  make_parent_folder(options.out);
  {
    Progress progress("simulating", scene->frame_count());
    hal::write_sequence(*scene, options.out,
                        [&](std::int64_t done, std::int64_t) { progress.show(done); });
  }
  std::printf("%lld frames in %s\n", static_cast<long long>(scene->frame_count()),
              options.out.c_str());
}

}  // namespace

void add_sim(CLI::App& app) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command =
      add_command(app, "sim", "Write a simulated recording with its ground truth.",
                  "lumibox sim hal/sim/scenes/toy.toml --out toy/", options->sources);
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command->add_option("--out", options->out, "sequence folder to be made")
      ->type_name("SEQ")
      ->required();
  command->callback([options] { simulate(*options); });
}

}  // namespace lumibox::app
