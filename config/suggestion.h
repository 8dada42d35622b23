#pragma once

#include <string>
#include <vector>

namespace lumibox::config {

/// The candidate with the fewest edits (letters inserted, removed or replaced; Levenshtein, 1966)
/// to `word`; empty if there is no candidate.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace lumibox::config
