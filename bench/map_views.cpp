#include "bench/map_views.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bench/axes.h"
#include "bench/plot_colors.h"
#include "geometry/robust.h"

namespace lumibox::bench {
namespace {

constexpr std::size_t kMaxPoints = 4000;  // more make a grey area, and a large file
constexpr double kGapS = 0.25;            // without a pose for longer, the line is broken

/// A view of the map: which of its axes lies to the right and which points up on the page.
struct Projection {
  const char* title;
  int across;
  int up;
};
constexpr Projection kTop{"Top view", 0, 1};
constexpr Projection kSide{"Side view, seen from the right", 1, 2};
constexpr const char* kNames[] = {"right", "ahead", "up"};

/// One view while it is drawn.
struct View {
  const Axes& axes;
  Projection projection;
  Eigen::Matrix3d map_from_world;

  Vector2d at(const Eigen::Vector3d& in_world) const {
    const Eigen::Vector3d p = map_from_world * in_world;
    return axes.at(p[projection.across], p[projection.up]);
  }
};

/// Points on the page, with a break wherever there was no pose for a while.
std::vector<Vector2d> line_of(const View& view, const std::vector<hal::StampedPose>& trajectory) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].timestamp_s - trajectory[i - 1].timestamp_s > kGapS) {
      points.emplace_back(Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    points.push_back(view.at(trajectory[i].world_from_camera.translation));
  }
  return points;
}

std::vector<Vector2d> thinned_points(const View& view, const std::vector<Eigen::Vector3d>& points) {
  const std::size_t step = points.size() / kMaxPoints + 1;
  std::vector<Vector2d> result;
  for (std::size_t i = 0; i < points.size(); i += step) {
    result.push_back(view.at(points[i]));
  }
  return result;
}

/// A dashed line from where the camera was lost to where it was found again.
void draw_losses(Svg& svg, const View& view, const TrackPlot& plot) {
  const auto& poses = plot.corrected;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto lost = std::ranges::count_if(plot.frames, [&](const PlottedFrame& frame) {
      return frame.timestamp_s > poses[i - 1].timestamp_s + 1e-6 &&
             frame.timestamp_s < poses[i].timestamp_s - 1e-6;
    });
    if (lost == 0) continue;
    const Vector2d from = view.at(poses[i - 1].world_from_camera.translation);
    const Vector2d to = view.at(poses[i].world_from_camera.translation);
    svg.line(from, to, {.stroke = colors::kLost, .width = 2.0, .dashes = "4 3"});
    for (const Vector2d& end : {from, to}) {
      svg.line(end - Vector2d(4, 4), end + Vector2d(4, 4), {.stroke = colors::kLost, .width = 2.0});
      svg.line(end - Vector2d(4, -4), end + Vector2d(4, -4),
               {.stroke = colors::kLost, .width = 2.0});
    }
  }
}

/// A dot with a line in the direction of view.
void draw_keyframe(Svg& svg, const View& view, const geometry::Pose& pose, double length) {
  const Eigen::Vector3d ahead =
      pose.translation + length * (pose.rotation.toRotationMatrix().col(2));
  svg.line(view.at(pose.translation), view.at(ahead), {.stroke = colors::kFinal, .opacity = 0.6});
  svg.circle(view.at(pose.translation), 2.2,
             {.stroke = colors::kFinal, .width = 0.8, .fill = "white"});
}

void draw_view(Svg& svg, const View& view, const TrackPlot& plot, double keyframe_length) {
  svg.clip(view.axes.corner(), view.axes.size());
  svg.dots(thinned_points(view, plot.points), 0.8, {.fill = colors::kPoint, .opacity = 0.6});
  for (const Eigen::Vector3d& center : plot.perspectives) {
    svg.rect(view.at(center) - Vector2d(3, 3), {6, 6},
             {.stroke = "white", .width = 0.6, .fill = colors::kPerspective});
  }
  svg.polyline(line_of(view, plot.truth), {.stroke = colors::kTruth, .width = 2.6, .opacity = 0.4});
  svg.polyline(line_of(view, plot.live), {.stroke = colors::kLive, .width = 1.6});
  svg.polyline(line_of(view, plot.corrected), {.stroke = colors::kFinal, .width = 1.2});
  for (const geometry::Pose& keyframe : plot.keyframes) {
    draw_keyframe(svg, view, keyframe, keyframe_length);
  }
  draw_losses(svg, view, plot);
  if (!plot.corrected.empty()) {
    const Vector2d start = view.at(plot.corrected.front().world_from_camera.translation);
    svg.circle(start, 5.0, {.stroke = "black", .width = 1.6});
    svg.text(start + Vector2d(8, 4), "start", {.size = 11, .bold = true});
  }
  svg.unclip();
}

/// What has to be in the views, along each axis of the map: all poses, and of the points what lies
/// around them.
std::array<Range, 3> extent(const TrackPlot& plot, const Eigen::Matrix3d& map_from_world) {
  constexpr double kAround = 1.5;  // lengths of the trajectory
  std::array<Range, 3> ranges;
  double length = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    Range& range = ranges[static_cast<std::size_t>(axis)];
    for (const auto* trajectory : {&plot.live, &plot.corrected, &plot.truth}) {
      for (const hal::StampedPose& pose : *trajectory) {
        range.include(map_from_world.row(axis) * pose.world_from_camera.translation);
      }
    }
    if (!range.empty()) length = std::max(length, range.high - range.low);
  }
  for (int axis = 0; axis < 3; ++axis) {
    Range& range = ranges[static_cast<std::size_t>(axis)];
    const Range poses = range;
    std::vector<double> values;
    for (const Eigen::Vector3d& point : plot.points) {
      values.push_back(map_from_world.row(axis) * point);
    }
    if (values.empty() || poses.empty()) continue;
    const double room = length > 0.0 ? kAround * length : std::numeric_limits<double>::infinity();
    const double least = poses.low - room;
    const double most = poses.high + room;
    range.include(std::clamp(geometry::quantile(values, 0.03), least, most));
    range.include(std::clamp(geometry::quantile(values, 0.97), least, most));
  }
  return ranges;
}

Range around_middle(const Range& range, double length) {
  const double middle = 0.5 * (range.low + range.high);
  return {middle - 0.5 * length, middle + 0.5 * length};
}

}  // namespace

Eigen::Matrix3d map_from_world(const std::vector<hal::StampedPose>& trajectory) {
  if (trajectory.empty()) return Eigen::Matrix3d::Identity();
  constexpr double kCamerasOwnUp = 0.05;  // its weight; decides where all look the same way
  constexpr double kAgreement = 0.5;  // cosine; if a camera rolls the two have nothing in common
  const auto count = static_cast<double>(trajectory.size());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_up = Eigen::Vector3d::Zero();
  for (const hal::StampedPose& pose : trajectory) {
    const Eigen::Matrix3d axes = pose.world_from_camera.matrix3();
    sum += axes.col(0) * axes.col(0).transpose() / count;
    mean_up -= axes.col(1) / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum - kCamerasOwnUp * mean_up *
                                                                       mean_up.transpose());
  Eigen::Vector3d up = eigen.eigenvectors().col(0);
  if (up.dot(mean_up) < 0.0) up = -up;
  if (up.dot(mean_up) < kAgreement * mean_up.norm()) up = mean_up.normalized();
  const Eigen::Vector3d first_right = trajectory.front().world_from_camera.matrix3().col(0);
  const Eigen::Vector3d ahead = up.cross(first_right).normalized();
  Eigen::Matrix3d rows;
  rows << ahead.cross(up).transpose(), ahead.transpose(), up.transpose();
  return rows;
}

void draw_map_views(Svg& svg, const TrackPlot& plot, const std::string& unit,
                    const Vector2d& corner, const Vector2d& size) {
  constexpr double kLeft = 55.0;  // for the labels of an axis
  constexpr double kGap = 30.0;
  const Eigen::Matrix3d turn = map_from_world(plot.corrected);
  std::array<Range, 3> ranges = extent(plot, turn);
  const double height = size.y() - 55.0;
  const double width = 0.5 * (size.x() - 2.0 * kLeft - kGap);
  // One scale for both views.
  double per_pixel = 0.0;
  for (Range& range : ranges) range = range.padded(0.06);
  for (const Projection& projection : {kTop, kSide}) {
    const auto length = [&](int axis) {
      const Range& range = ranges[static_cast<std::size_t>(axis)];
      return range.high - range.low;
    };
    per_pixel =
        std::max({per_pixel, length(projection.across) / width, length(projection.up) / height});
  }
  double x = corner.x() + kLeft;
  for (const Projection& projection : {kTop, kSide}) {
    const auto axis = [&](int index, double pixels) {
      return Axis{std::string(kNames[index]) + " [" + unit + "]",
                  around_middle(ranges[static_cast<std::size_t>(index)], pixels * per_pixel)};
    };
    const Axes axes({x, corner.y() + 20.0}, {width, height}, axis(projection.across, width),
                    axis(projection.up, height));
    axes.draw(svg, projection.title);
    draw_view(svg, {axes, projection, turn}, plot, 14.0 * per_pixel);
    x += width + kGap + kLeft;
  }
}

}  // namespace lumibox::bench
