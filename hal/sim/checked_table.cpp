#include "hal/sim/checked_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/error.h"

namespace lumibox::hal::sim {
namespace {

std::string show(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string show(Range range) {
  return show(range.min) + " to " + show(range.max);
}

template <typename Names>
std::string joined(const Names& names) {
  std::string list;
  for (const auto& name : names) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list;
}

/// "[key]" or "[[key]]".
std::string header(std::string_view key, std::string_view open, std::string_view close) {
  std::string text(open);
  text += key;
  text += close;
  return text;
}

int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}

}  // namespace

void CheckedTable::fail(std::string_view key, const std::string& message) const {
  const toml::node* node = table_->get(key);
  // Tables that a header opened implicitly have no line of their own.
  const int line = std::max(1, line_of(node != nullptr ? *node : *table_));
  throw config::InputError(file_, line, name_ + " " + std::string(key) + ": " + message);
}

const toml::node* CheckedTable::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

bool CheckedTable::has(std::string_view key) {
  return find(key) != nullptr;
}

double CheckedTable::number(std::string_view key, Range range, std::optional<double> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) {
    if (fallback) return *fallback;
    fail(key, "is missing; expected a number, " + show(range));
  }
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value) fail(key, "expected a number, " + show(range));
  // Written so that NaN is refused.
  if (!(*value >= range.min && *value <= range.max)) {
    fail(key, "is " + show(*value) + "; allowed: " + show(range));
  }
  return *value;
}

int CheckedTable::integer(std::string_view key, Range range, std::optional<int> fallback) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_integer()) fail(key, "expected an integer, " + show(range));
  return static_cast<int>(number(key, range, fallback));
}

std::string CheckedTable::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) {
    if (fallback) return *fallback;
    fail(key, "is missing; expected a string");
  }
  const auto* value = node->as_string();
  if (value == nullptr) fail(key, "expected a string");
  return value->get();
}

std::vector<double> CheckedTable::number_list(std::string_view key, const toml::node& node,
                                              int count, Range range) const {
  const std::string wanted =
      "expected " + std::to_string(count) + " numbers in brackets, each " + show(range);
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != static_cast<std::size_t>(count)) fail(key, wanted);
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const double value = element.value<double>().value_or(std::nan(""));
    if (!element.is_number() || !(value >= range.min && value <= range.max)) fail(key, wanted);
    values.push_back(value);
  }
  return values;
}

Eigen::VectorXd CheckedTable::numbers(std::string_view key, int count, Range range,
                                      const std::optional<Eigen::VectorXd>& fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) {
    if (fallback) return *fallback;
    fail(key, "is missing; expected " + std::to_string(count) + " numbers in brackets");
  }
  const std::vector<double> values = number_list(key, *node, count, range);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), count);
}

std::size_t CheckedTable::choice(std::string_view key, std::span<const std::string_view> choices,
                                 std::optional<std::size_t> fallback) {
  if (find(key) == nullptr) {
    if (fallback) return *fallback;
    fail(key, "is missing; allowed: " + joined(choices));
  }
  const std::string value = text(key);
  const auto found = std::find(choices.begin(), choices.end(), value);
  if (found == choices.end()) fail(key, "is \"" + value + "\"; allowed: " + joined(choices));
  return static_cast<std::size_t>(found - choices.begin());
}

std::vector<std::string> CheckedTable::texts(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "is missing; expected a list of strings");
  const toml::array* array = node->as_array();
  if (array == nullptr || array->empty()) fail(key, "expected a list of strings");
  std::vector<std::string> values;
  for (const toml::node& element : *array) {
    if (!element.is_string()) fail(key, "expected a list of strings");
    values.push_back(element.as_string()->get());
  }
  return values;
}

std::vector<Eigen::VectorXd> CheckedTable::rows(std::string_view key, int count, Range range) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr)
    fail(key, "expected a list of lists of " + std::to_string(count) + " numbers");
  std::vector<Eigen::VectorXd> result;
  for (const toml::node& element : *array) {
    const std::vector<double> values = number_list(key, element, count, range);
    result.emplace_back(Eigen::Map<const Eigen::VectorXd>(values.data(), count));
  }
  return result;
}

std::optional<CheckedTable> CheckedTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) fail(key, "expected a table");
  return CheckedTable(*node->as_table(), file_, header(key, "[", "]"));
}

std::vector<CheckedTable> CheckedTable::tables(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  const std::string title = header(key, "[[", "]]");
  if (array == nullptr) fail(key, "expected tables, each begun by " + title);
  std::vector<CheckedTable> result;
  for (const toml::node& element : *array) {
    if (!element.is_table()) fail(key, "expected tables, each begun by " + title);
    result.emplace_back(*element.as_table(), file_, title);
  }
  return result;
}

void CheckedTable::finish() const {
  for (const auto& [key, node] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) == known_.end()) {
      std::vector<std::string> allowed = known_;
      std::sort(allowed.begin(), allowed.end());
      allowed.erase(std::unique(allowed.begin(), allowed.end()), allowed.end());
      fail(key.str(), "unknown key; allowed: " + joined(allowed));
    }
  }
}

}  // namespace lumibox::hal::sim
