#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "calibration/board.h"
#include "calibration/judgement.h"
#include "config/camera_profile.h"
#include "config/config.h"

namespace lumibox::calibration {

struct Request {
  Board board;
  int width = 0;  ///< pixels, of all pictures
  int height = 0;
  config::LensModel model = config::LensModel::Opencv;
  bool keep_outliers = false;
  config::Calibration limits;
};

/// What became of a sighting.
struct View {
  double tilt = 0.0;      ///< radians, from frontal
  double error_px = 0.0;  ///< RMS; of a dropped view with the lens that was found with it
  bool dropped = false;   ///< far worse than the others
};

struct Estimate {
  std::string_view name;
  double value = 0.0;
  double deviation = 0.0;  ///< standard deviation
};

struct Calibration {
  config::CameraProfile profile;
  std::vector<Estimate> estimates;  ///< of what the profile's model has
  std::vector<View> views;          ///< as the sightings
  double error_px = 0.0;            ///< RMS over the corners of all views kept
  double tilt_spread = 0.0;         ///< radians
};

/// Why there is no calibration.
struct Refusal {
  enum class Reason {
    TooFewViews,
    NotCovered,     ///< parts of the picture without corners
    BoardFrontal,   ///< the board faces the camera in all views
    ViewsAlike,     ///< its tilts are too similar
    NoLens,         ///< no lens explains the views
    ErrorTooLarge,  ///< the best one does badly
    Uncertain,      ///< many lenses explain them as well
    LensFolds,      ///< the distortion found turns back inside the picture
  };
  Reason reason;
  std::string message;  ///< one line: what was found, what is expected
};

/// The lens that explains the sightings, without those that none explains; or why it is not to be
/// trusted.
std::variant<Calibration, Refusal> calibrate(const Request& request,
                                             std::span<const Sighting> sightings);

}  // namespace lumibox::calibration
