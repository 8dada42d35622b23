#include "config/suggestion.h"

#include <gtest/gtest.h>

namespace lumibox::config {
namespace {

TEST(Suggestion, IsTheCandidateWithTheFewestEdits) {
  EXPECT_EQ(nearest("lvel", {"rate", "level", "k"}), "level");    // one inserted
  EXPECT_EQ(nearest("levels", {"rate", "level", "k"}), "level");  // one removed
  EXPECT_EQ(nearest("lebel", {"rate", "level", "k"}), "level");   // one replaced
  EXPECT_EQ(nearest("kitten", {"mitten", "sitting"}), "mitten");
}

TEST(Suggestion, OfNothingIsNothing) {
  EXPECT_EQ(nearest("level", {}), "");
}

TEST(Suggestion, OfWhatNobodyMeantIsNothing) {
  EXPECT_EQ(nearest("banana", {"level", "k"}), "");
  EXPECT_EQ(nearest("", {"abc", "ab"}), "");
  EXPECT_EQ(nearest("leevl", {"rate", "level"}), "level") << "two letters that changed places";
}

}  // namespace
}  // namespace lumibox::config
