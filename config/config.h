#pragma once

#include <cstdint>
#include <string>

namespace lumibox::config {

/// Every threshold of the box, grouped by the layer that uses it. Default, unit, range and origin
/// of each value stand in lumibox.toml beside this file; schema.cpp holds the same as a table.
/// Angles are degrees here and radians everywhere else.

struct Loop {
  double rate_hz = 30.0;  ///< ticks per second
};

struct Tracking {
  int pyramid_levels = 4;                ///< levels, each half the size of the one below
  int max_measurements = 700;            ///< map points searched for per frame
  int max_features_per_keyframe = 1200;  ///< corners kept on all levels of a keyframe
  int fast_threshold = 10;               ///< grey levels
  double init_max_depth_sigma = 0.03;    ///< relative error of a typical depth in the first map
  int init_min_inliers = 80;             ///< points in a two-view map
  double search_radius_px = 4.0;         ///< of the level searched, after the coarse pass
  double lost_inlier_share = 0.25;  ///< share of searched points found below which quality is bad
  int lost_after_frames = 5;        ///< bad frames in a row until the tracker is lost
  int pose_iterations = 10;         ///< steps of a pose from its measurements, at most
  int local_keyframes = 8;          ///< keyframes in a local bundle adjustment
  int local_iterations = 5;         ///< steps of a local bundle adjustment, at most
  int global_iterations = 20;       ///< steps of an adjustment of the whole map, at most
  double keyframe_parallax_deg = 4.5;  ///< median parallax to the nearest keyframe for a new one
};

struct Capture {
  double threshold_deg = 4.0;      ///< angle at S below which a perspective is not new (thesis 2.3)
  double threshold_step = 1.25;    ///< factor of one press of + or -
  double threshold_min_deg = 0.5;  ///< smallest threshold the buttons reach
  double threshold_max_deg = 30.0;    ///< largest threshold the buttons reach
  int jpeg_quality = 92;              ///< 1..100
  double sphere_radius_share = 0.35;  ///< radius of the first sphere as a share of its distance
  double depth_step = 0.05;           ///< one press of +/-: relative step of inverse depth
  double moved_share = 0.002;  ///< correction of the map below which a recorded pose is left alone,
                               ///< as a share of the distance to the subject
  double map_interval_s = 5.0;      ///< between two times that the map is kept with the capture
  double widest_gap_deg = 60.0;     ///< between recorded directions, to be filled
  std::string folder = "captures";  ///< where `run` keeps its captures
};

/// Of the weights, in the configuration and on the command line: beyond, only the nearest counts.
inline constexpr double kLargestExponent = 64.0;

struct Render {
  std::string geometry = "mesh";       ///< that pictures are shown on
  int k = 40;                          ///< perspectives blended (thesis 3: 40 to 60)
  int small_aperture_max_k = 40;       ///< cap of k in small aperture mode (thesis 3.2)
  double exponent = 2.0;               ///< of the weights in wide aperture mode (thesis 3.2)
  double feather_px = 24.0;            ///< width of the faded border (thesis 3)
  double small_aperture_alpha = 0.4;   ///< alpha of the nearer half (thesis 3.2)
  double small_aperture_stop = 0.004;  ///< transmittance at which a pixel is done
  int aperture_views = 64;             ///< of the smooth wide aperture of a view at rest
  int texture_mb = 128;                ///< MiB of pictures kept on the GPU
};

struct Quality {
  double disagreement_sigmas = 5.0;  ///< beyond the usual, from which a picture disagrees
  double least_shift_deg = 0.4;      ///< that counts as disagreement, however little is usual
  double least_difference = 12.0;    ///< grey levels; likewise
};

struct Aperture {
  int frames = 12;        ///< pictures kept for the augmented aperture (thesis 2.2)
  double gate_deg = 0.5;  ///< angle at the focus between two of them
};

struct Calibration {
  int min_views = 8;          ///< pictures of the board that the lens must explain
  double max_error_px = 1.0;  ///< RMS reprojection error above which a calibration is refused
};

struct Controls {
  double long_press_s = 0.6;     ///< held this long, a press is a long one
  double stuck_s = 60.0;         ///< held this long, a button is stuck and says nothing more
  double orbit_period_s = 12.0;  ///< one round of the automatic orbit in review
};

/// Buttons and a lamp that are wired to the board. A line is NAME, or CHIP:OFFSET with the chip's
/// name, label, path or number; a button without a line is not there.
struct Gpio {
  std::string main;
  std::string review;
  std::string plus;
  std::string minus;
  std::string wipe;
  bool active_low = true;        ///< a button that is down pulls its line to ground
  std::string bias = "pull-up";  ///< as-is, pull-up, pull-down or disabled
  double debounce_ms = 10.0;     ///< quiet after which a switch has done bouncing
  bool led_active_low = false;   ///< the lamp is lit when its line is at ground
};

/// Keys of keyboards and remotes: for each button names from linux/input-event-codes.h, any of
/// which is that button.
struct Evdev {
  std::string main = "KEY_ENTER KEY_KPENTER KEY_SPACE KEY_OK KEY_SELECT KEY_PLAYPAUSE KEY_CAMERA";
  std::string review = "KEY_R KEY_TAB KEY_MENU KEY_INFO";
  std::string plus = "KEY_EQUAL KEY_KPPLUS KEY_UP KEY_PAGEUP KEY_VOLUMEUP";
  std::string minus = "KEY_MINUS KEY_KPMINUS KEY_DOWN KEY_PAGEDOWN KEY_VOLUMEDOWN";
  std::string wipe = "KEY_BACKSPACE KEY_DELETE KEY_BACK";
  bool grab = false;  ///< what the devices say is for the box alone
};

/// The screen of the box, where devices.display is kms.
struct Display {
  std::string mode;      ///< WIDTHxHEIGHT or WIDTHxHEIGHT@HZ; empty: what the screen prefers
  int rotation_deg = 0;  ///< of pictures on the panel, clockwise: 0, 90, 180 or 270
};

/// What the box is made of; app/devices.cpp knows the kinds.
struct Devices {
  std::string clock = "system";  ///< system, or virtual: as fast as the work allows
  std::string camera;            ///< v4l2:DEVICE, libcamera:CAMERA, sim:SCENE.toml, replay:SEQUENCE
  std::string calibration;       ///< of the camera, in place of a recording's own
  /// none, or, with commas, any of script:FILE, gpio, evdev:any, evdev:PATH, evdev:NAME, window
  std::string buttons = "none";
  std::string status_led = "none";            ///< none, or gpio:LINE
  std::string display = "offscreen:640x480";  ///< offscreen:, window:WIDTHxHEIGHT, kms:CARD
};

/// What is asked of a camera that is opened through v4l2 or libcamera.
struct Camera {
  std::string format = "auto";      ///< auto, or a name of hal/live/modes.h
  int width = 0;                    ///< pixels; 0: the calibration's, or 640 without one
  int height = 0;                   ///< pixels; 0: the calibration's, or 480 without one
  double rate_hz = 30.0;            ///< frames per second
  std::string power_line = "asis";  ///< asis, off, 50hz, 60hz, auto; v4l2 only
  int stall_periods = 60;           ///< of a frame, without one, until its stream is begun anew
};

struct Log {
  std::string level = "info";  ///< trace, debug, info, warn, error
};

struct Config {
  Loop loop;
  Tracking tracking;
  Capture capture;
  Render render;
  Quality quality;
  Aperture aperture;
  Calibration calibration;
  Controls controls;
  Gpio gpio;
  Evdev evdev;
  Devices devices;
  Camera camera;
  Display display;
  Log log;
};

}  // namespace lumibox::config
