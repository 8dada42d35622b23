#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace lumibox::calibration {

/// What is printed: a chessboard, or one with markers in its white squares (ChArUco), which may be
/// seen in part. Its frame: origin in corner 0, x along a row, y along a column, z = 0, metres.
struct Board {
  struct Markers {
    std::string dictionary;  ///< one of dictionaries()
    double side_m = 0.0;
  };

  int columns = 9;  ///< inner corners in a row: one less than squares
  int rows = 6;
  double square_m = 0.025;
  std::optional<Markers> markers;  ///< of a ChArUco board
};

/// What is wrong with a board, in words that name the number and what is expected; or none.
std::optional<std::string> fault_of(const Board& board);

/// OpenCV's names of the marker dictionaries; their places are its numbers of them.
const std::vector<std::string>& dictionaries();

/// Corners are counted along the rows from 0.
Eigen::Vector2d corner_on_board(const Board& board, int id);

struct Corner {
  int id = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// The board in one picture.
using Sighting = std::vector<Corner>;

}  // namespace lumibox::calibration
