#include "app/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/commands.h"
#include "render/view.h"

// The only file that knows CLI11, which takes long to compile.
namespace lumibox::app {
namespace {

/// CLI::Range takes what is not a number for a number in range.
std::string must_be_finite(const std::string& text) {
  return std::isfinite(std::strtod(text.c_str(), nullptr))
             ? ""
             : "found " + text + "; expected a number";
}

/// A path of no letters would be the folder that the program happens to run in.
std::string must_not_be_empty(const std::string& text) {
  return text.empty() ? "found nothing; expected a word" : "";
}

/// A subcommand with the options that all have, and an example in its help.
template <typename Options>
CLI::App* add_command(CLI::App& app, const char* name, const char* description, const char* example,
                      const std::shared_ptr<Options>& options, void (*run)(const Options&)) {
  CLI::App* command = app.add_subcommand(name, description);
  command->add_option("--config", options->sources.file, "configuration file (see lumibox.toml)")
      ->type_name("FILE");
  command
      ->add_option("--set", options->sources.assignments,
                   "one setting, e.g. --set capture.threshold_deg=3")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  command->footer(std::string("Example:\n  ") + example);
  command->callback([options, run] { run(*options); });
  return command;
}

void add_capture(CLI::App* command, std::filesystem::path& capture) {
  command->add_option("CAPTURE", capture, "capture folder")->required();
}

void add_reference(CLI::App* command, bool& reference) {
  command->add_flag("--reference", reference, "the exact renderer on the CPU");
}

void add_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = add_command(
      app, "run", "The box itself: camera, buttons and display as the configuration names them.",
      "lumibox run --set 'devices.camera=replay:walk/' --set 'devices.buttons=script:presses.txt'",
      options, run);
  command
      ->add_option("--last-good", options->last_good,
                   "keep a copy of --config here once the box works with it, and use that when it "
                   "does not")
      ->type_name("FILE")
      ->needs(command->get_option("--config"));
}

void add_cameras(CLI::App& app) {
  add_command(app, "cameras",
              "The cameras of this machine: formats, sizes and rates, and what can be adjusted.",
              "lumibox cameras", std::make_shared<CamerasOptions>(), show_cameras);
}

void add_demo(CLI::App& app) {
  const auto options = std::make_shared<DemoOptions>();
  CLI::App* command = add_command(
      app, "demo", "A simulated box from the first picture to the review, without any hardware.",
      "lumibox demo --out out/demo", options, demo);
  command->add_option("--out", options->out, "folder for the pictures and the capture")
      ->type_name("DIR")
      ->capture_default_str();
  command
      ->add_option("--rate", options->rate_hz,
                   "ticks per simulated second; the camera has 30, and fewer are over sooner")
      ->type_name("HZ")
      ->check(CLI::Range(5.0, 60.0))
      ->check(must_be_finite)
      ->capture_default_str();
}

SubjectPixel parse_subject(const std::string& text) {
  SubjectPixel subject;
  long long frame = -1;
  int read = 0;
  const int count = std::sscanf(text.c_str(), "%lf,%lf@%lld%n", &subject.pixel.x(),
                                &subject.pixel.y(), &frame, &read);
  if (count != 3 || frame < 0 || !subject.pixel.allFinite() ||
      static_cast<std::size_t>(read) != text.size()) {
    throw CLI::ValidationError("--subject",
                               "found " + text + "; expected U,V@FRAME, e.g. 320,240@45");
  }
  subject.frame = frame;
  return subject;
}

void add_track(CLI::App& app) {
  const auto options = std::make_shared<TrackOptions>();
  CLI::App* command =
      add_command(app, "track", "Track a recording; write its trajectory and, if asked, a capture.",
                  "lumibox track walk/ --out walk.tum --json walk.json --capture walk_capture/",
                  options, track);
  command->add_option("SEQ", options->sequence, "sequence folder, folder of images, or video")
      ->required();
  command->add_option("--out", options->out, "trajectory with the final corrections (TUM)")
      ->type_name("TRAJ.tum")
      ->required();
  command->add_option("--live", options->live, "trajectory as known when each frame was shown")
      ->type_name("LIVE.tum");
  command->add_option("--json", options->json, "statistics")->type_name("STATS");
  command->add_option("--plot", options->plot, "map, errors and states as a picture (SVG)")
      ->type_name("OUT.svg");
  command->add_option("--seed", options->seed, "of the random sampling")
      ->check(CLI::Range(std::uint32_t{0}, std::numeric_limits<std::uint32_t>::max()))
      ->type_name("N");
  command
      ->add_option("--calib", options->calibration,
                   "calib.txt or camera profile (.toml) in place of the sequence's own")
      ->type_name("CALIB");
  command->add_flag("--realtime", options->realtime,
                    "play at the recorded rate; frames that come too fast are dropped");
  command
      ->add_option("--resume", options->resume,
                   "go on in the map that was kept with this capture; with the same folder as "
                   "--capture go on with the capture, too")
      ->type_name("CAPTURE");
  CLI::Option* capture =
      command->add_option("--capture", options->capture, "record a light field into this folder")
          ->type_name("DIR");
  command
      ->add_option_function<std::string>(
          "--subject",
          [options](const std::string& text) { options->subject = parse_subject(text); },
          "where the subject is: pixel and frame (default: the middle, as soon as possible)")
      ->type_name("U,V@FRAME")
      ->needs(capture);
}

void add_render(CLI::App& app) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command = add_command(
      app, "render", "Render a capture from the poses of a trajectory, one PNG per line.",
      "lumibox render walk_capture/ --views views.tum --out pictures/ --mode wide", options,
      render_views);
  add_capture(command, options->capture);
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
      ->check(CLI::Range(0.0, config::kLargestExponent))
      ->check(must_be_finite)
      ->type_name("X");
  command
      ->add_option("--geometry", options->geometry,
                   "what the pictures are projected onto: a plane through the subject, a plane at "
                   "the depth that serves the view best, or the scene's shape (default: "
                   "render.geometry, but plane with --mode wide)")
      ->check(CLI::IsMember({"plane", "focal", "mesh"}))
      ->type_name("NAME");
  command
      ->add_option("--calib", options->calibration,
                   "calib.txt or camera profile (.toml) with the intrinsics of the views "
                   "(default: the capture's, undistorted)")
      ->type_name("CALIB");
  add_reference(command, options->reference);
}

void add_evaluate(CLI::App& app) {
  const auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command =
      add_command(app, "evaluate", "How well each perspective can be rendered from all the others.",
                  "lumibox evaluate walk_capture/ --json quality.json", options, evaluate);
  add_capture(command, options->capture);
  command->add_option("--json", options->json, "one row per method, and the rows per view")
      ->type_name("FILE");
  command->add_option("--pictures", options->pictures, "folder for what was rendered")
      ->type_name("DIR");
  add_reference(command, options->reference);
}

void add_import(CLI::App& app) {
  const auto options = std::make_shared<ImportOptions>();
  CLI::App* command =
      add_command(app, "import", "Make a capture of a data set with known poses.",
                  "lumibox import fox/transforms.json fox_capture/", options, import_data_set);
  command
      ->add_option("SOURCE", options->source,
                   "nerfstudio or instant-ngp transforms.json, or a folder with a COLMAP model")
      ->required();
  command->add_option("CAPTURE", options->capture, "folder to be made")->required();
}

void add_export(CLI::App& app) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command = add_command(
      app, "export", "Write a capture in the layout of another program.",
      "lumibox export walk_capture/ --format colmap --out walk_colmap/", options, export_data_set);
  add_capture(command, options->capture);
  command->add_option("--format", options->format, "layout")
      ->check(CLI::IsMember({"nerfstudio", "colmap"}))
      ->required();
  command->add_option("--out", options->out, "folder to be made")->type_name("PATH")->required();
}

void parse_board(const std::string& text, calibration::Board& board) {
  int read = 0;
  const int count = std::sscanf(text.c_str(), "%4dx%4d%n", &board.columns, &board.rows, &read);
  if (count != 2 || static_cast<std::size_t>(read) != text.size()) {
    throw CLI::ValidationError("--board", "found " + text + "; expected COLUMNSxROWS, e.g. 9x6");
  }
}

void add_markers(CLI::App* command, const std::shared_ptr<CalibrateOptions>& options) {
  const auto markers = [options]() -> calibration::Board::Markers& {
    auto& all = options->board.markers;
    return all ? *all : all.emplace();
  };
  CLI::Option* charuco =
      command
          ->add_option_function<std::string>(
              "--charuco",
              [markers](const std::string& dictionary) { markers().dictionary = dictionary; },
              "a ChArUco board with markers of this dictionary, e.g. DICT_4X4_50")
          ->type_name("DICT");
  CLI::Option* marker = command
                            ->add_option_function<double>(
                                "--marker", [markers](double side_m) { markers().side_m = side_m; },
                                "side of a marker, metres")
                            ->type_name("METRES");
  charuco->needs(marker);
  marker->needs(charuco);
  command
      ->add_option("--window", options->window_px,
                   "half the window in which a chessboard's corner is refined, pixels (default: "
                   "from the distance of the corners)")
      ->check(CLI::Range(2, 50))
      ->type_name("N")
      ->excludes(charuco);
}

void add_calibrate(CLI::App& app) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = add_command(
      app, "calibrate", "Find a camera's lens from pictures of a chessboard or ChArUco board.",
      "lumibox calibrate board*.jpg --board 9x6 --square 0.025 --out webcam.toml", options,
      calibrate);
  command->add_option("IMAGES", options->images, "pictures of the board")->required();
  command
      ->add_option_function<std::string>(
          "--board", [options](const std::string& text) { parse_board(text, options->board); },
          "inner corners of the board, one less than squares each way")
      ->type_name("COLUMNSxROWS")
      ->required();
  command->add_option("--square", options->board.square_m, "side of a square, metres")
      ->type_name("METRES")
      ->required();
  command->add_option("--out", options->out, "camera profile to write")
      ->type_name("PROFILE.toml")
      ->required();
  command->add_option("--model", options->model, "lens")
      ->check(CLI::IsMember({"opencv", "fisheye"}))
      ->capture_default_str();
  add_markers(command, options);
  command->add_flag("--keep-outliers", options->keep_outliers,
                    "use pictures too that are far worse than the others");
  command->add_option("--fps", options->fps, "frames per second, for the profile")
      ->check(CLI::Range(0.01, 1000.0))
      ->check(must_be_finite)
      ->capture_default_str();
  command
      ->add_option("--readout", options->readout_s,
                   "time from the first row to the last, for the profile")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1.0))
      ->check(must_be_finite)
      ->capture_default_str();
}

/// The index of a word among those allowed.
template <std::size_t n>
std::size_t index_of(const std::array<std::string_view, n>& words, const std::string& word) {
  return static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
}

template <std::size_t n>
CLI::IsMember one_of(const std::array<std::string_view, n>& words) {
  return CLI::IsMember(std::vector<std::string>(words.begin(), words.end()));
}

/// Options come in any order, so whichever is first makes the random scene.
hal::sim::RandomSceneOptions& random_scene(SimOptions& options) {
  return options.random_scene ? *options.random_scene : options.random_scene.emplace();
}

/// What may be stated of a random scene, all else drawn.
void add_random_scene(CLI::App* command, CLI::Option* seed,
                      const std::shared_ptr<SimOptions>& options) {
  namespace sim = hal::sim;
  command
      ->add_option_function<std::string>(
          "--place",
          [options](const std::string& name) {
            random_scene(*options).place =
                static_cast<sim::Place>(index_of(sim::kPlaceNames, name));
          },
          "where the random scene is (default: drawn)")
      ->check(one_of(sim::kPlaceNames))
      ->needs(seed);
  command
      ->add_option_function<std::string>(
          "--walk",
          [options](const std::string& name) {
            random_scene(*options).walk = static_cast<sim::Walk>(index_of(sim::kWalkNames, name));
          },
          "how it is walked (default: drawn)")
      ->check(one_of(sim::kWalkNames))
      ->needs(seed);
  command
      ->add_option_function<std::vector<std::string>>(
          "--effects",
          [options](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
              random_scene(*options).effects.insert(
                  static_cast<sim::Effect>(index_of(sim::kEffectNames, name)));
            }
          },
          "effects of the random scene, commas between them (default: none)")
      ->delimiter(',')
      ->check(one_of(sim::kEffectNames))
      ->needs(seed);
}

void add_sim(CLI::App& app) {
  const auto options = std::make_shared<SimOptions>();
  CLI::App* command = add_command(app, "sim", "Write a simulated recording with its ground truth.",
                                  "lumibox sim --random 7 --place desk --walk orbit --out walk/",
                                  options, simulate);
  CLI::Option_group* source = command->add_option_group("Scene", "either of them");
  source->add_option("SCENE", options->scene, "scene file (TOML)");
  CLI::Option* seed =
      source
          ->add_option_function<std::uint64_t>(
              "--random", [options](std::uint64_t n) { random_scene(*options).seed = n; },
              "a scene drawn at random")
          ->check(CLI::Range(std::uint32_t{0}, std::numeric_limits<std::uint32_t>::max()))
          ->type_name("SEED");
  source->require_option(1);
  add_random_scene(command, seed, options);
  command->add_option("--out", options->out, "sequence folder to be made")
      ->type_name("SEQ")
      ->required();
}

SeedRange parse_seeds(const std::string& text) {
  SeedRange seeds;
  int read = 0;
  const int count = std::sscanf(text.c_str(), "%9u-%9u%n", &seeds.first, &seeds.last, &read);
  // Pictures are kept in memory, 60 MB of each scene.
  constexpr std::uint32_t kMost = 100;
  if (count != 2 || static_cast<std::size_t>(read) != text.size() || seeds.last < seeds.first ||
      seeds.last - seeds.first >= kMost) {
    throw CLI::ValidationError(
        "--random", "found " + text + "; expected FIRST-LAST, at most 100 seeds, e.g. 1-8");
  }
  return seeds;
}

void add_bench(CLI::App& app) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* command = add_command(
      app, "bench",
      "What accuracy costs in time, of the tracker or the renderer, one setting varied at a time; "
      "or "
      "a frame of each simulated scene. JSON lines and, but for the simulation, a plot.",
      "lumibox bench tracking --out out/bench --sequence walk/", options, run_bench);
  command->add_option("WHAT", options->what, "what is measured")
      ->check(CLI::IsMember({"tracking", "rendering", "simulation"}))
      ->capture_default_str();
  command->add_option("--out", options->out, "folder for WHAT.jsonl and the plot WHAT.svg")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--sequence", options->sequences,
                   "tracking: a recording to measure besides the simulated toy; may be repeated")
      ->type_name("SEQ")
      ->allow_extra_args(false);
  command
      ->add_option("--scene", options->scenes,
                   "rendering: a scene file in place of the simulated toy; may be repeated")
      ->type_name("SCENE.toml")
      ->allow_extra_args(false);
  command
      ->add_option_function<std::string>(
          "--random", [options](const std::string& text) { options->random = parse_seeds(text); },
          "scenes drawn at random besides; table and plot have the medians over them")
      ->type_name("FIRST-LAST");
  command
      ->add_option("--frames", options->frames,
                   "tracking, simulation: how many of each recording or scene, at most")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100000}))
      ->capture_default_str();
  command
      ->add_option(
          "--runs", options->runs,
          "tracking: of each value, each with another seed; table and plot have the medians")
      ->type_name("N")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command
      ->add_option("--views", options->views,
                   "rendering: of each scene, at most, between the recorded ones")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--perspectives", options->perspectives,
                   "rendering: around the subject, for the memory; for the speed, at most 300")
      ->type_name("N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
}

/// CLI11 says of an unknown command only that one is required.
std::string failure_message(const CLI::App* app, const CLI::Error& error) {
  if (!app->get_subcommands().empty() || error.get_name() != "RequiredError") {
    return CLI::FailureMessage::simple(app, error);
  }
  const std::vector<std::string> words = app->remaining();
  std::string message = words.empty() ? "no command" : "no command '" + words.front() + "'";
  const char* separator = "; expected ";
  for (const CLI::App* command : app->get_subcommands({})) {
    message += separator + command->get_name();
    separator = ", ";
  }
  return message + "\nRun with --help for more information.\n";
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("Lumibox: walk around something, and a light field of it is on the screen.",
               "lumibox");
  app.require_subcommand(1);
  app.failure_message(failure_message);
  app.set_version_flag("--version", LUMIBOX_VERSION);
  app.footer("`lumibox COMMAND --help` explains each command with an example.");
  add_run(app);
  add_cameras(app);
  add_demo(app);
  add_track(app);
  add_render(app);
  add_evaluate(app);
  add_import(app);
  add_export(app);
  add_calibrate(app);
  add_sim(app);
  add_bench(app);
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) option->check(must_not_be_empty);
  }
  try {
    app.parse(argc, argv);  // runs the command named
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
}

}  // namespace lumibox::app
