#include "lightfield/text_numbers.h"

#include <array>
#include <charconv>
#include <cmath>

namespace lumibox::lightfield {
namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n\v\f";

template <typename Number>
bool parse_all(std::string_view word, Number* value) {
  const char* end = word.data() + word.size();
  const std::from_chars_result result = std::from_chars(word.data(), end, *value);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace

std::string to_text(double value) {
  std::array<char, 32> text{};  // the longest double has 24 characters
  const std::to_chars_result result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string six_digits(int number) {
  std::string digits = std::to_string(number);
  digits.insert(0, digits.size() < 6 ? 6 - digits.size() : 0, '0');
  return digits;
}

std::string printable(std::string_view text) {
  std::string shown(text.substr(0, 80));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return shown;
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kWhiteSpace);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    words.push_back(line.substr(0, line.find_first_of(kWhiteSpace)));
    line.remove_prefix(words.back().size());
  }
}

bool parse(std::string_view word, double* value) {
  return parse_all(word, value) && std::isfinite(*value);
}

bool parse(std::string_view word, long long* value) {
  return parse_all(word, value);
}

}  // namespace lumibox::lightfield
