#include "hal/replay/text_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/input_file.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;
using config::InputError;

constexpr std::string_view kSpace = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

}  // namespace

TextLine::TextLine(const fs::path& file, int line, std::string_view text)
    : file_(&file), line_(line), text_(trimmed(text)) {
  for (std::string_view rest = text_; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of(kSpace), rest.size());
    fields_.push_back(rest.substr(0, end));
    rest = trimmed(rest.substr(end));
  }
}

double TextLine::number(std::size_t column) const {
  const std::string_view field = fields_.at(column);
  double value = 0.0;
  const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (status != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
    throw error(quoted(column) + " is not a finite number");
  }
  return value;
}

int TextLine::integer(std::size_t column) const {
  const std::string_view field = fields_.at(column);
  int value = 0;
  const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (status != std::errc() || end != field.data() + field.size()) {
    throw error(quoted(column) + " is not a whole number");
  }
  return value;
}

std::string TextLine::rest_after_first() const {
  return std::string(trimmed(text_.substr(fields_.front().size())));
}

void TextLine::expect_count(int min, int max, const std::string& expected) const {
  if (count() < min || count() > max) {
    throw error(std::to_string(count()) + " fields; expected " + expected);
  }
}

std::string TextLine::quoted(std::size_t column) const {
  constexpr std::size_t kMaxLength = 40;
  std::string text(1, '\'');
  return text.append(fields_.at(column).substr(0, kMaxLength)) + "'";
}

InputError TextLine::error(const std::string& message) const {
  return {*file_, line_, message};
}

TextFile::TextFile(const fs::path& file) : file_(file), text_(config::read_text(file)) {
  int line = 1;
  for (std::string_view rest = text_; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view content = trimmed(rest.substr(0, end));
    if (!content.empty() && content.front() != '#') {
      lines_.emplace_back(file_, line, content);
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

}  // namespace lumibox::hal
