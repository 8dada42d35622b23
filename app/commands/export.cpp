#include <cstdio>
#include <string>

#include "app/commands/commands.h"
#include "config/error.h"
#include "lightfield/capture.h"

namespace lumibox::app {
namespace {

struct ExportOptions {
  config::Sources sources;
  std::filesystem::path capture;
  std::filesystem::path out;
  std::string format;
};

lightfield::ExportFormat format_named(const std::string& name) {
  if (name == "nerfstudio") {
    return lightfield::ExportFormat::Nerfstudio;
  }
  if (name == "colmap") {
    return lightfield::ExportFormat::Colmap;
  }
  throw config::InputError("--format " + name + ": not available yet: nerfstudio, colmap");
}

void export_from(const ExportOptions& options) {
  const config::Config config = load_config(options.sources);
  const lightfield::ExportFormat format = format_named(options.format);
  refuse_used_folder(options.out);
  const lightfield::Capture capture = lightfield::load_capture(options.capture);
  lightfield::export_capture(capture, format, options.out, config.capture.jpeg_quality);
  std::printf("%zu perspectives in %s\n", capture.light_field.perspectives().size(),
              options.out.c_str());
}

}  // namespace

void add_export(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = add_command(
      app, "export", "Write a capture in the layout of another program.",
      "lumibox export walk_capture/ --format colmap --out walk_colmap/", options->sources);
  command->add_option("CAPTURE", options->capture, "capture folder")->required();
  command->add_option("--format", options->format, "layout")
      ->check(CLI::IsMember({"nerfstudio", "colmap", "llff", "web"}))
      ->required();
  command->add_option("--out", options->out, "folder to be made")->type_name("PATH")->required();
  command->callback([options] { export_from(*options); });
}

}  // namespace lumibox::app
