#include "config/suggestion.h"

#include <algorithm>
#include <numeric>

namespace lumibox::config {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  // row[j]: edits from the letters of a seen so far to the first j letters of b.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  const auto best = std::ranges::min_element(
      candidates, {}, [&](const std::string& candidate) { return edit_distance(word, candidate); });
  const std::size_t farthest = std::max<std::size_t>(1, (word.size() + 1) / 3);
  const bool is_near = best != candidates.end() && edit_distance(word, *best) <= farthest;
  return is_near ? *best : std::string();
}

}  // namespace lumibox::config
