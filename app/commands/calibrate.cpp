#include "calibration/calibrate.h"

#include <fmt/core.h>

#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "calibration/detector.h"
#include "config/error.h"
#include "hal/image_io.h"
#include "lightfield/durable_files.h"

namespace lumibox::app {
namespace {

namespace fs = std::filesystem;

/// The pictures in which the board is, and what is common to all.
struct Sightings {
  std::vector<fs::path> pictures;
  std::vector<calibration::Sighting> sightings;
  int width = 0;
  int height = 0;
};

void check(const CalibrateOptions& options) {
  if (const auto fault = calibration::fault_of(options.board)) {
    throw config::InputError("calibrate: " + *fault);
  }
  if (options.out.extension() != ".toml") {
    throw config::InputError(options.out, "is to be a camera profile; expected a name in .toml");
  }
  require_writable(options.out);
}

Sightings find_boards(const CalibrateOptions& options) {
  Sightings found;
  const calibration::Detector detector(options.board, options.window_px);
  const auto count = static_cast<std::int64_t>(options.images.size());
  Progress progress("looking for the board", count);
  for (std::int64_t i = 0; i < count; ++i) {
    const fs::path& file = options.images[static_cast<std::size_t>(i)];
    const hal::Image picture = hal::to_gray(hal::read_image(file));
    if (i == 0) {
      found.width = picture.width();
      found.height = picture.height();
    } else if (picture.width() != found.width || picture.height() != found.height) {
      throw config::InputError(
          file, fmt::format("picture of {}x{} pixels; expected {}x{}, as of {}", picture.width(),
                            picture.height(), found.width, found.height,
                            options.images.front().string()));
    }
    if (auto sighting = detector.find(picture)) {
      found.pictures.push_back(file);
      found.sightings.push_back(*std::move(sighting));
    } else {
      std::printf("%s: no board\n", file.c_str());
    }
    progress.show(i + 1);
  }
  if (found.sightings.empty()) {
    throw config::InputError(fmt::format(
        "calibrate: no board of {}x{} inner corners in any of {} pictures; expected it whole, flat "
        "and sharp, with a white border",
        options.board.columns, options.board.rows, count));
  }
  return found;
}

void say(const Sightings& found, const calibration::Calibration& result) {
  std::size_t corners = 0;
  for (std::size_t i = 0; i < result.views.size(); ++i) {
    const calibration::View& view = result.views[i];
    const std::size_t in_view = found.sightings[i].size();
    if (!view.dropped) corners += in_view;
    std::printf("%s: %zu corners, tilted by %.0f deg, error %.2f px%s\n", found.pictures[i].c_str(),
                in_view, view.tilt * 180.0 / std::numbers::pi, view.error_px,
                view.dropped ? ": DROPPED, far worse than the others" : "");
  }
  for (const calibration::Estimate& estimate : result.estimates) {
    std::printf("%s = %.6g, standard deviation %.2g\n", std::string(estimate.name).c_str(),
                estimate.value, estimate.deviation);
  }
  std::printf("reprojection error %.3f px (RMS over %zu corners)\n", result.error_px, corners);
}

}  // namespace

void calibrate(const CalibrateOptions& options) {
  const config::Config config = load_config(options.sources);
  check(options);
  const Sightings found = find_boards(options);
  calibration::Request request;
  request.board = options.board;
  request.width = found.width;
  request.height = found.height;
  request.model =
      options.model == "fisheye" ? config::LensModel::Fisheye : config::LensModel::Opencv;
  request.keep_outliers = options.keep_outliers;
  request.limits = config.calibration;
  const auto answer = calibration::calibrate(request, found.sightings);
  if (const auto* refusal = std::get_if<calibration::Refusal>(&answer)) {
    throw config::InputError(
        fmt::format("calibrate: of {} pictures: {}", options.images.size(), refusal->message));
  }
  const auto& result = std::get<calibration::Calibration>(answer);
  config::CameraProfile profile = result.profile;
  profile.fps = options.fps;
  profile.readout_s = options.readout_s;
  say(found, result);
  lightfield::DurableFiles().write(options.out, config::profile_text(profile));
  std::printf("profile in %s\n", options.out.c_str());
}

}  // namespace lumibox::app
