#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

// The board behind the library that fake_libgpiod_1.cpp and fake_libgpiod_2.cpp stand in for.
namespace lumibox::testing {

/// Of libgpiod, whose calls this program has.
extern const int kFakeLibgpiod;

struct FakeEdge {
  bool rising = false;  ///< by the logical level
  std::int64_t time_ns = 0;
};

struct FakeLine {
  std::string name = {};
  std::string user = {};  ///< who has it; empty: it is free
  bool high = false;      ///< on the wire

  // As it was asked for.
  bool is_input = false;
  bool tells_edges = false;  ///< both, by the monotonic clock
  bool active_low = false;
  std::string bias = "as-is";

  std::size_t kept_edges = 16;  ///< at most, between two readings

  std::deque<FakeEdge> edges = {};  ///< kept for the reader
  bool gone = false;                ///< its chip was unplugged
  bool hangs_up = false;            ///< and the kernel says so at once, as newer ones do

  bool is_active() const { return high != active_low; }
};

struct FakeChip {
  std::string name;
  std::string label;
  std::vector<FakeLine> lines;
  bool is_denied = false;  ///< no permission
};

struct FakeBoard {
  std::vector<FakeChip> chips;
  int open_objects = 0;  ///< of the library, not closed yet

  /// The line's level is changed from outside.
  void drive(FakeLine& line, bool high, std::int64_t time_ns);

  FakeLine* line_named(const std::string& name);
};

/// The only one: the library's calls have no place for another.
FakeBoard& fake_board();

}  // namespace lumibox::testing
