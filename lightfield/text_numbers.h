#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumibox::lightfield {

/// Shortest text that reads back as the same double, whatever the locale.
std::string to_text(double value);

/// With zeros before it if it has fewer than six digits, as in names of files.
std::string six_digits(int number);

/// A piece of a bad file fit for a one-line message: the beginning, without control characters.
std::string printable(std::string_view text);

/// The words of a line, split at white space.
std::vector<std::string_view> split_words(std::string_view line);

/// Reads all of `word` as a number of this type; false if it is not one, out of range or, for
/// doubles, not finite.
bool parse(std::string_view word, double* value);
bool parse(std::string_view word, long long* value);

}  // namespace lumibox::lightfield
