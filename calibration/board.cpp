#include "calibration/board.h"

#include <fmt/core.h>

#include <algorithm>

namespace lumibox::calibration {

std::optional<std::string> fault_of(const Board& board) {
  constexpr int kFewest = 3;  // fewer are not told from other checks by findChessboardCorners
  constexpr int kMost = 50;
  for (const int side : {board.columns, board.rows}) {
    if (side < kFewest || side > kMost) {
      return fmt::format("board of {}x{} inner corners; expected {} to {} each way", board.columns,
                         board.rows, kFewest, kMost);
    }
  }
  if (!(board.square_m >= 1e-4 && board.square_m <= 10.0)) {
    return fmt::format("squares of {} m; expected 0.0001 to 10 m", board.square_m);
  }
  if (!board.markers) return std::nullopt;
  if (std::ranges::find(dictionaries(), board.markers->dictionary) == dictionaries().end()) {
    return "no marker dictionary " + board.markers->dictionary + "; expected e.g. DICT_4X4_50";
  }
  if (!(board.markers->side_m > 0.0 && board.markers->side_m < board.square_m)) {
    return fmt::format("markers of {} m; expected less than the squares' {} m",
                       board.markers->side_m, board.square_m);
  }
  return std::nullopt;
}

const std::vector<std::string>& dictionaries() {
  static const std::vector<std::string> kNames{
      "DICT_4X4_50",   "DICT_4X4_100",       "DICT_4X4_250",  "DICT_4X4_1000", "DICT_5X5_50",
      "DICT_5X5_100",  "DICT_5X5_250",       "DICT_5X5_1000", "DICT_6X6_50",   "DICT_6X6_100",
      "DICT_6X6_250",  "DICT_6X6_1000",      "DICT_7X7_50",   "DICT_7X7_100",  "DICT_7X7_250",
      "DICT_7X7_1000", "DICT_ARUCO_ORIGINAL"};
  return kNames;
}

Eigen::Vector2d corner_on_board(const Board& board, int id) {
  return board.square_m * Eigen::Vector2d(id % board.columns, id / board.columns);
}

}  // namespace lumibox::calibration
