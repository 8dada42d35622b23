#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/camera_profile.h"
#include "geometry/pose.h"
#include "hal/sim/color.h"

/// A scene file as plain data; docs/simulation.md explains every key. World: metres, z up.
namespace lumibox::hal::sim {

enum class Pattern { Plain, Noise, Wood, Checker, Bricks, Facade, Poster, Books, Plaid };

struct TextureSpec {
  std::string name;
  Pattern pattern = Pattern::Plain;
  Eigen::Vector2d tile_m{1.0, 1.0};  ///< size on the surface before it repeats
  int texels_x = 1024;               ///< powers of two
  int texels_y = 1024;               ///< powers of two
  double cell_m = 0.1;               ///< size of the pattern's largest element
  double grain = 0.25;               ///< contrast of the fine noise over it, 0..1
  std::vector<Color> palette{Color(0.5f, 0.5f, 0.5f)};  ///< sRGB
  std::uint64_t seed = 1;
};

enum class Shape { Quad, Box, Sphere, Cylinder, Torus, Lathe, Extrusion, Mesh };

struct Displacement {
  double amplitude_m = 0.0;  ///< peak, along the normal
  double cell_m = 0.05;      ///< size of the largest bump
  std::uint64_t seed = 1;
};

struct ObjectSpec {
  std::string name;
  Shape shape = Shape::Box;
  Eigen::Vector3d size{1.0, 1.0, 1.0};   ///< extent along x, y, z; a quad has no z
  double tube_m = 0.1;                   ///< torus: radius of the tube
  std::vector<Eigen::Vector2d> profile;  ///< lathe: (radius, height); extrusion: outline (x, y)
  std::filesystem::path file;            ///< mesh: an OBJ file
  int segments = 48;                     ///< facets around
  Displacement displacement;
  geometry::Pose world_from_object;
  std::string texture;
  double texture_scale = 1.0;       ///< 2 shows the texture twice as large
  double mirror = 0.0;              ///< share of light reflected; needs the effect "reflection"
  std::optional<double> glass_ior;  ///< refractive index; needs the effect "refraction"
  Color glass_tint{1.0f, 1.0f, 1.0f};
};

enum class LightKind { Ambient, Directional, Point };
enum class Shadows { None, Baked, Traced };

struct LightSpec {
  LightKind kind = LightKind::Ambient;
  Color color{1.0f, 1.0f, 1.0f};  ///< linear, times strength; irradiance / pi on a facing surface
  Eigen::Vector3d direction{0.0, 0.0, -1.0};  ///< the light travels, unit
  Eigen::Vector3d position{0.0, 0.0, 2.0};
  double falloff_m = 1.0;     ///< point: distance at which it has its nominal strength
  double reach_m = 0.5;       ///< ambient: surfaces nearer than this keep it away
  double softness_deg = 3.0;  ///< half angle under which the light is seen
  Shadows shadows = Shadows::None;
};

struct WobbleSpec {
  double position_mm = 0.0;   ///< root mean square of each coordinate
  double rotation_deg = 0.0;  ///< root mean square about each axis
  double min_hz = 0.5;
  double max_hz = 8.0;
  std::uint64_t seed = 1;
};

/// A jolt: a wobble that swells and dies away.
struct ShakeSpec {
  double start_s = 0.0;
  double duration_s = 0.5;
  WobbleSpec wobble;  ///< root mean squares as if it lasted for ever at the strength of its middle
};

struct OrbitSpec {
  Eigen::Vector2d azimuth_deg{-60.0, 60.0};
  Eigen::Vector2d elevation_deg{10.0, 60.0};
  int rows = 1;                        ///< sweeps, each at its own elevation
  Eigen::Vector2d radius_m{0.7, 0.7};  ///< drifts between these
};

struct KeyPose {
  double time_s = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
};

struct PathSpec {
  std::optional<OrbitSpec> orbit;  ///< otherwise the keys
  std::vector<KeyPose> keys;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< of the orbit
  double lead_in_s = 0.0;                            ///< sideways motion before the walk
  double lead_in_m = 0.0;                            ///< its length
  WobbleSpec tremor;
  std::optional<ShakeSpec> shake;
};

struct LensDistortionSpec {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
};
struct RollingShutterSpec {
  double readout_s = 0.0;
};
struct MotionBlurSpec {
  double exposure_s = 0.0;
  int samples = 8;
};
struct VignettingSpec {
  double corner = 0.6;  ///< brightness of the image's corner relative to its centre
};
struct AutoExposureSpec {
  double target = 0.18;  ///< mean luminance aimed at, linear
  double lag_s = 0.3;    ///< time constant
  double min_gain = 0.25;
  double max_gain = 16.0;
};
struct SensorNoiseSpec {
  double full_well = 8000.0;  ///< electrons at white and gain 1
  double read = 4.0;          ///< electrons, root mean square
  std::uint64_t seed = 1;
};
struct OpticsSpec {
  int depth = 4;  ///< surfaces a ray may meet
};
struct MovingSubjectSpec {
  std::vector<std::string> objects;  ///< move together
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();
  WobbleSpec wobble;
};
struct OccluderSpec {
  Eigen::Vector3d size{0.2, 0.2, 0.2};  ///< of an ellipsoid
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double start_s = 0.0;
  double duration_s = 1.0;
  std::string texture;
};
struct DroppedFramesSpec {
  double share = 0.02;  ///< probability that a gap begins at a frame
  int burst = 2;        ///< longest gap, frames
  std::uint64_t seed = 1;
};

enum class Effect {
  LensDistortion,
  RollingShutter,
  MotionBlur,
  Vignetting,
  AutoExposure,
  SensorNoise,
  Reflection,
  Refraction,
  MovingSubject,
  PassingOccluder,
  DroppedFrames,
};
/// What people call them, in the order of the enumeration.
inline constexpr std::array<std::string_view, 11> kEffectNames{
    "lens_distortion", "rolling_shutter",  "motion_blur",   "vignetting",
    "auto_exposure",   "sensor_noise",     "reflection",    "refraction",
    "moving_subject",  "passing_occluder", "dropped_frames"};

/// What the scene names. An effect that is absent is never constructed.
struct EffectSpecs {
  std::optional<LensDistortionSpec> lens_distortion;
  std::optional<RollingShutterSpec> rolling_shutter;
  std::optional<MotionBlurSpec> motion_blur;
  std::optional<VignettingSpec> vignetting;
  std::optional<AutoExposureSpec> auto_exposure;
  std::optional<SensorNoiseSpec> sensor_noise;
  std::optional<OpticsSpec> reflection;
  std::optional<OpticsSpec> refraction;
  std::vector<MovingSubjectSpec> moving_subjects;
  std::vector<OccluderSpec> occluders;
  std::optional<DroppedFramesSpec> dropped_frames;
};

struct SceneSpec {
  double duration_s = 1.0;
  Color background{0.5f, 0.6f, 0.7f};  ///< linear
  config::CameraProfile camera;        ///< lens and shutter effects included
  double exposure = 1.0;               ///< factor before the sRGB curve
  Eigen::Vector3d subject_center = Eigen::Vector3d::Zero();
  double subject_radius_m = 1.0;
  std::vector<TextureSpec> textures;
  std::vector<ObjectSpec> objects;
  std::vector<LightSpec> lights;
  PathSpec path;
  EffectSpecs effects;
};

}  // namespace lumibox::hal::sim
