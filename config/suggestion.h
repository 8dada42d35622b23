#pragma once

#include <string>
#include <vector>

namespace lumibox::config {

/// The candidate with the fewest edits (letters inserted, removed or replaced; Levenshtein, 1966)
/// to `word`; empty if even that is too far to have been meant: more than one edit in three
/// letters.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace lumibox::config
