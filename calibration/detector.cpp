#include "calibration/detector.h"

#include <algorithm>
#include <limits>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "tracking/opencv_view.h"

namespace lumibox::calibration {
namespace {

/// Shortest distance between neighbours of a chessboard's corners, pixels.
double least_spacing(const std::vector<cv::Point2f>& corners, int columns) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto step = static_cast<std::size_t>(columns);
    if ((i + 1) % step != 0) least = std::min(least, cv::norm(corners[i] - corners[i + 1]));
    if (i + step < corners.size()) {
      least = std::min(least, cv::norm(corners[i] - corners[i + step]));
    }
  }
  return least;
}

/// cornerSubPix takes every gradient in its window for one of the corner's own two edges. On the
/// pictures of OpenCV's samples the error grows as soon as the window is wider than 0.4 of the
/// spacing (RMS 0.18 px up to 0.4, 0.47 at 0.45, 0.94 at 0.5).
int window_for(double spacing) {
  constexpr double kShareOfSpacing = 0.35;
  constexpr double kLargest = 11.0;  // of OpenCV's samples; more adds blur's and the lens's bends
  return static_cast<int>(std::clamp(kShareOfSpacing * spacing, 2.0, kLargest));
}

/// A pose needs corners in two rows and two columns, and a few more than the four of a homography
/// for their error to show.
bool enough_for_a_pose(const Sighting& sighting, int columns) {
  constexpr std::size_t kFewest = 8;
  std::set<int> in_rows;
  std::set<int> in_columns;
  for (const Corner& corner : sighting) {
    in_rows.insert(corner.id / columns);
    in_columns.insert(corner.id % columns);
  }
  return sighting.size() >= kFewest && in_rows.size() >= 2 && in_columns.size() >= 2;
}

Sighting sighting_of(const std::vector<cv::Point2f>& corners, const std::vector<int>& ids) {
  Sighting sighting;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sighting.push_back({ids[i], {corners[i].x, corners[i].y}});
  }
  return sighting;
}

}  // namespace

class Detector::Impl {
 public:
  Impl(const Board& board, std::optional<int> window_px) : board_(board), window_px_(window_px) {
    if (!board.markers) return;
    const auto place = std::ranges::find(dictionaries(), board.markers->dictionary);
    const auto dictionary =
        cv::aruco::getPredefinedDictionary(static_cast<int>(place - dictionaries().begin()));
    charuco_ = cv::aruco::CharucoBoard::create(
        board.columns + 1, board.rows + 1, static_cast<float>(board.square_m),
        static_cast<float>(board.markers->side_m), dictionary);
  }

  std::optional<Sighting> find(const hal::Image& gray) const {
    const cv::Mat picture = tracking::opencv_view(gray);
    std::optional<Sighting> found = charuco_ ? find_charuco(picture) : find_chessboard(picture);
    if (found && !enough_for_a_pose(*found, board_.columns)) found.reset();
    return found;
  }

 private:
  std::optional<Sighting> find_chessboard(const cv::Mat& picture) const {
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCorners(picture, {board_.columns, board_.rows}, corners)) {
      return std::nullopt;
    }
    const int half = window_px_.value_or(window_for(least_spacing(corners, board_.columns)));
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-4);
    cv::cornerSubPix(picture, corners, {half, half}, {-1, -1}, until);
    std::vector<int> ids(corners.size());
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<int>(i);
    return sighting_of(corners, ids);
  }

  std::optional<Sighting> find_charuco(const cv::Mat& picture) const {
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> marker_ids;
    cv::aruco::detectMarkers(picture, charuco_->dictionary, markers, marker_ids);
    if (marker_ids.empty()) return std::nullopt;
    std::vector<cv::Point2f> corners;
    std::vector<int> ids;
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, picture, charuco_, corners, ids);
    // This function alone counts from the picture's corner: it ends with `corner + (0.5, 0.5)`.
    for (cv::Point2f& corner : corners) corner -= cv::Point2f(0.5F, 0.5F);
    return sighting_of(corners, ids);
  }

  Board board_;
  std::optional<int> window_px_;
  cv::Ptr<cv::aruco::CharucoBoard> charuco_;
};

Detector::Detector(const Board& board, std::optional<int> window_px)
    : impl_(std::make_unique<Impl>(board, window_px)) {}
Detector::~Detector() = default;

std::optional<Sighting> Detector::find(const hal::Image& gray) const {
  return impl_->find(gray);
}

}  // namespace lumibox::calibration
