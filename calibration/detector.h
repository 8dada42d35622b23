#pragma once

#include <memory>
#include <optional>

#include "calibration/board.h"
#include "hal/image.h"

namespace lumibox::calibration {

/// Finds a board in pictures, with OpenCV.
class Detector {
 public:
  /// `window_px`: half the side of the window in which each corner of a chessboard is refined; none
  /// chooses the largest that holds no other corner's edges.
  explicit Detector(const Board& board, std::optional<int> window_px = std::nullopt);
  ~Detector();
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;

  /// The corners in a one-channel picture: of a chessboard all, of a ChArUco board those whose
  /// markers were read; none if the board is not there or too little of it for a pose.
  std::optional<Sighting> find(const hal::Image& gray) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::calibration
