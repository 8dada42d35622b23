#include "calibration/detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/synthetic_board.h"

namespace lumibox::calibration {
namespace {

using ::testing::HasSubstr;

Board charuco_board() {
  Board board;
  board.columns = 7;
  board.rows = 5;
  board.markers = Board::Markers{"DICT_4X4_50", 0.018};
  return board;
}

/// RMS distance of the corners from where they are; boards without markers may be read from either
/// end.
double error_px(const Board& board, const Sighting& found, const Sighting& truth) {
  double forwards = 0.0;
  double backwards = 0.0;
  const int last = board.columns * board.rows - 1;
  for (const Corner& corner : found) {
    for (const Corner& expected : truth) {
      const double error = (corner.pixel - expected.pixel).squaredNorm();
      if (expected.id == corner.id) forwards += error;
      if (expected.id == last - corner.id) backwards += error;
    }
  }
  const double least = board.markers ? forwards : std::min(forwards, backwards);
  return std::sqrt(least / static_cast<double>(found.size()));
}

TEST(Detector, FindsAChessboardToAFractionOfAPixel) {
  const Board board;
  const Detector detector(board);
  const geometry::Pose pose = test::varied_poses(board, test::webcam(), 5)[4];
  const auto found = detector.find(test::picture_of(board, test::webcam(), pose));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), 54U);
  EXPECT_LT(error_px(board, *found, test::observe(board, test::webcam(), pose, 0, 0)), 0.15);
}

// The window in which a corner is refined must not reach the next corner's edges.
TEST(Detector, FindsASmallBoardToo) {
  const Board board;
  geometry::Pose pose = test::varied_poses(board, test::webcam(), 5)[4];
  pose.translation *= 2.2;
  const hal::Image picture = test::picture_of(board, test::webcam(), pose);
  const Sighting truth = test::observe(board, test::webcam(), pose, 0, 0);
  const auto found = Detector(board).find(picture);
  ASSERT_TRUE(found);
  EXPECT_LT(error_px(board, *found, truth), 0.15);
  const auto too_wide = Detector(board, 11).find(picture);
  ASSERT_TRUE(too_wide);
  EXPECT_GT(error_px(board, *too_wide, truth), 0.5);
}

TEST(Detector, FindsACharucoBoardThatIsSeenInPart) {
  const Board board = charuco_board();
  geometry::Pose pose = test::varied_poses(board, test::webcam(), 5)[4];
  pose.translation.x() += 0.24;
  const Sighting truth = test::observe(board, test::webcam(), pose, 0, 0);
  ASSERT_LT(truth.size(), 35U);
  const auto found = Detector(board).find(test::picture_of(board, test::webcam(), pose));
  ASSERT_TRUE(found);
  EXPECT_GE(found->size(), 10U);
  EXPECT_LT(error_px(board, *found, truth), 0.25);
}

TEST(Detector, FindsNothingWhereThereIsNoBoard) {
  hal::Image grey(320, 240, 1);
  EXPECT_FALSE(Detector(Board{}).find(grey));
  EXPECT_FALSE(Detector(charuco_board()).find(grey));
}

TEST(Board, FaultsAreNamed) {
  EXPECT_FALSE(fault_of(Board{}));
  EXPECT_FALSE(fault_of(charuco_board()));
  Board board = charuco_board();
  board.columns = 2;
  EXPECT_THAT(*fault_of(board), HasSubstr("2x5 inner corners; expected 3"));
  board = charuco_board();
  board.square_m = 25.0;
  EXPECT_THAT(*fault_of(board), HasSubstr("squares of 25 m"));
  board = charuco_board();
  board.markers->side_m = 0.025;
  EXPECT_THAT(*fault_of(board), HasSubstr("markers of 0.025 m"));
  board.markers->dictionary = "DICT_9X9";
  EXPECT_THAT(*fault_of(board), HasSubstr("DICT_9X9"));
}

}  // namespace
}  // namespace lumibox::calibration
