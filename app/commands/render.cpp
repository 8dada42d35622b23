#include <spdlog/fmt/fmt.h>

#include <optional>
#include <string>

#include "app/commands/commands.h"
#include "app/painter.h"
#include "app/progress.h"
#include "config/error.h"
#include "hal/image_io.h"
#include "hal/replay/sequence.h"
#include "lightfield/capture.h"
#include "render/view.h"

namespace lumibox::app {
namespace {

struct RenderOptions {
  config::Sources sources;
  std::filesystem::path capture;
  std::filesystem::path views;
  std::filesystem::path out;
  std::string mode = "small";
  std::string geometry = "plane";
  std::optional<int> k;
  std::optional<double> exponent;
  std::optional<std::filesystem::path> calibration;
  bool reference = false;
};

render::Settings settings_of(const RenderOptions& options, const lightfield::Sphere& subject) {
  config::Render render = load_config(options.sources).render;
  render.k = options.k.value_or(render.k);
  render.exponent = options.exponent.value_or(render.exponent);
  const auto aperture = options.mode == "wide" ? render::Aperture::Wide : render::Aperture::Small;
  return render::settings_from(render, aperture, subject.center);
}

void render_views(const RenderOptions& options) {
  if (options.geometry != "plane") {
    throw config::InputError("--geometry " + options.geometry + ": not available yet: plane");
  }
  const lightfield::Capture capture = lightfield::load_capture(options.capture);
  const auto& perspectives = capture.light_field.perspectives();
  if (perspectives.empty() || !capture.light_field.subject()) {
    throw config::InputError(options.capture, "holds no perspectives to render from");
  }
  const render::Settings settings = settings_of(options, *capture.light_field.subject());
  const auto views = hal::read_tum_trajectory(options.views);
  const geometry::Camera camera =
      options.calibration ? geometry::Camera(hal::read_calibration(*options.calibration))
                          : *perspectives.front().camera;
  Painter painter(options.reference ? Exactness::Exact : Exactness::Fast);
  make_folder(options.out);
  Progress progress("rendering", static_cast<std::int64_t>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const render::View view{camera.undistorted(), views[i].world_from_camera};
    hal::write_png(options.out / fmt::format("{:06}.png", i),
                   painter.paint(view, perspectives, settings));
    progress.show(static_cast<std::int64_t>(i + 1));
  }
}

}  // namespace

void add_render(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = add_command(
      app, "render", "Render a capture from the poses of a trajectory, one PNG per line.",
      "lumibox render walk_capture/ --views views.tum --out pictures/ --mode wide",
      options->sources);
  command->add_option("CAPTURE", options->capture, "capture folder")->required();
  command->add_option("--views", options->views, "poses, world from camera, in the capture's world")
      ->type_name("VIEWS.tum")
      ->required();
  command->add_option("--out", options->out, "folder for 000000.png and on")
      ->type_name("DIR")
      ->required();
  command->add_option("--mode", options->mode, "aperture (thesis 3.2)")
      ->check(CLI::IsMember({"small", "wide"}))
      ->capture_default_str();
  command->add_option("--k", options->k, "perspectives blended (default: render.k)")
      ->check(CLI::Range(1, static_cast<int>(render::kMaxLayers)))
      ->type_name("N");
  command->add_option("--exponent", options->exponent, "of the weights (default: render.exponent)")
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("X");
  command->add_option("--geometry", options->geometry, "what the pictures are projected onto")
      ->check(CLI::IsMember({"plane", "focal", "mesh"}))
      ->capture_default_str();
  command
      ->add_option("--calib", options->calibration,
                   "intrinsics of the views (default: the capture's, undistorted)")
      ->type_name("CALIB.txt");
  command->add_flag("--reference", options->reference, "the exact renderer on the CPU");
  command->callback([options] { render_views(*options); });
}

}  // namespace lumibox::app
