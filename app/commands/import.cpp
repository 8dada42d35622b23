#include <cstdio>

#include "app/commands/commands.h"
#include "lightfield/capture.h"

namespace lumibox::app {
namespace {

struct ImportOptions {
  config::Sources sources;
  std::filesystem::path source;
  std::filesystem::path capture;
};

void import_into(const ImportOptions& options) {
  const config::Config config = load_config(options.sources);
  refuse_used_folder(options.capture);
  const lightfield::Capture capture = lightfield::import_capture(options.source);
  lightfield::save_capture(capture, options.capture, config.capture.jpeg_quality);
  std::printf("%zu perspectives in %s\n", capture.light_field.perspectives().size(),
              options.capture.c_str());
}

}  // namespace

void add_import(CLI::App& app) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command =
      add_command(app, "import", "Make a capture of a data set with known poses.",
                  "lumibox import fox/transforms.json fox_capture/", options->sources);
  command
      ->add_option("SOURCE", options->source,
                   "nerfstudio or instant-ngp transforms.json, or a folder with a COLMAP model")
      ->required();
  command->add_option("CAPTURE", options->capture, "folder to be made")->required();
  command->callback([options] { import_into(*options); });
}

}  // namespace lumibox::app
