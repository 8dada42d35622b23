#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/auto_capture.h"
#include "calibration/board.h"
#include "config/loader.h"
#include "hal/sim/random_scene.h"

/// The subcommands and what each can be told; command_line.cpp says it to the person. All throw
/// config::InputError for input that they cannot use.
namespace lumibox::app {

struct RunOptions {
  config::Sources sources;
  /// Copy of sources.file as it was when the box last worked, and what is used where that does not.
  std::optional<std::filesystem::path> last_good;
};
void run(const RunOptions& options);

struct CamerasOptions {
  config::Sources sources;
};
void show_cameras(const CamerasOptions& options);

struct DemoOptions {
  config::Sources sources;
  std::filesystem::path out = "lumibox-demo";
  double rate_hz = 15.0;
};
void demo(const DemoOptions& options);

struct TrackOptions {
  config::Sources sources;
  std::filesystem::path sequence;
  std::filesystem::path out;
  std::optional<std::filesystem::path> live;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> plot;
  std::optional<std::filesystem::path> calibration;
  std::optional<std::filesystem::path> capture;
  std::optional<SubjectPixel> subject;          ///< none: the middle, as soon as possible
  std::optional<std::filesystem::path> resume;  ///< capture in whose map to go on
  std::uint32_t seed = 0;
  bool realtime = false;
};
void track(const TrackOptions& options);

struct RenderOptions {
  config::Sources sources;
  std::filesystem::path capture;
  std::filesystem::path views;
  std::filesystem::path out;
  std::string mode = "small";
  std::optional<std::string> geometry;
  std::optional<int> k;
  std::optional<double> exponent;
  std::optional<std::filesystem::path> calibration;
  bool reference = false;
};
void render_views(const RenderOptions& options);

struct EvaluateOptions {
  config::Sources sources;
  std::filesystem::path capture;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> pictures;
  bool reference = false;
};
void evaluate(const EvaluateOptions& options);

struct ImportOptions {
  config::Sources sources;
  std::filesystem::path source;
  std::filesystem::path capture;
};
void import_data_set(const ImportOptions& options);

struct ExportOptions {
  config::Sources sources;
  std::filesystem::path capture;
  std::filesystem::path out;
  std::string format;
};
void export_data_set(const ExportOptions& options);

struct CalibrateOptions {
  config::Sources sources;
  std::vector<std::filesystem::path> images;
  calibration::Board board;
  std::filesystem::path out;
  std::string model = "opencv";
  std::optional<int> window_px;  ///< none: as wide as the board's spacing allows
  bool keep_outliers = false;
  double fps = 30.0;
  double readout_s = 0.0;
};
void calibrate(const CalibrateOptions& options);

struct SimOptions {
  config::Sources sources;
  std::optional<std::filesystem::path> scene;                ///< a file
  std::optional<hal::sim::RandomSceneOptions> random_scene;  ///< in its place
  std::filesystem::path out;
};
void simulate(const SimOptions& options);

/// From `first` to `last`, both included.
struct SeedRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

struct BenchOptions {
  config::Sources sources;
  std::string what = "tracking";  ///< or "rendering", "simulation"
  std::filesystem::path out;
  std::vector<std::filesystem::path> sequences;
  std::vector<std::filesystem::path> scenes;  ///< to be rendered; empty: the toy
  std::optional<SeedRange> random;            ///< scenes drawn at random, judged together
  std::int64_t frames = 200;                  ///< of each recording or scene, at most
  int runs = 1;                               ///< of each variation, each with a seed of its own
  std::size_t views = 12;                     ///< that are rendered of each scene, at most
  std::size_t perspectives = 420;             ///< around the subject, of which memory is measured
};
void run_bench(const BenchOptions& options);

}  // namespace lumibox::app
