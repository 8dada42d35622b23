#include "config/key.h"

#include <algorithm>
#include <optional>
#include <sstream>

namespace lumibox::config {
namespace {

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

std::string in_words(const Value& value) {
  std::ostringstream words;
  words << std::boolalpha;
  std::visit(Overloaded{[&](const std::string& text) { words << '"' << text << '"'; },
                        [&](const auto& other) { words << other; }},
             value);
  return words.str();
}

std::optional<double> as_number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    return static_cast<double>(*whole);
  }
  if (const auto* real = std::get_if<double>(&value)) {
    return *real;
  }
  return std::nullopt;
}

/// True where there is nothing to choose from, too.
bool is_choice(const std::string& text, const Key& key) {
  return key.choices.empty() || std::ranges::find(key.choices, text) != key.choices.end();
}

bool in_range(double number, const Key& key) {
  return number >= key.min && number <= key.max;  // false for NaN
}

/// Each takes the value into the member if it has the right type and is allowed.
bool take(bool& member, const Value& value, const Key& /*key*/) {
  const auto* flag = std::get_if<bool>(&value);
  if (flag != nullptr) {
    member = *flag;
  }
  return flag != nullptr;
}

bool take(int& member, const Value& value, const Key& key) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  if (whole == nullptr || !in_range(static_cast<double>(*whole), key) ||
      !is_choice(std::to_string(*whole), key)) {
    return false;
  }
  member = static_cast<int>(*whole);
  return true;
}

bool take(double& member, const Value& value, const Key& key) {
  const std::optional<double> number = as_number(value);
  if (!number || !in_range(*number, key)) {
    return false;
  }
  member = *number;
  return true;
}

bool take(std::string& member, const Value& value, const Key& key) {
  const auto* text = std::get_if<std::string>(&value);
  if (text == nullptr) {
    return false;
  }
  const bool allowed = is_choice(*text, key) && static_cast<double>(text->size()) >= key.min;
  if (allowed) {
    member = *text;
  }
  return allowed;
}

std::string range_of(const Key& key) {
  std::ostringstream words;
  for (const std::string_view choice : key.choices) {
    words << (words.tellp() == 0 ? "one of " : ", ") << choice;
  }
  if (!key.choices.empty()) return words.str();
  if (std::holds_alternative<bool*>(key.member)) {
    words << "true or false";
  } else if (std::holds_alternative<std::string*>(key.member)) {
    words << (key.min > 0.0 ? "any text but an empty one" : "any text");
  } else {
    words.precision(10);
    words << key.min << " to " << key.max;
  }
  return words.str();
}

}  // namespace

std::string Key::full_name() const {
  return section.empty() ? std::string(name) : std::string(section) + "." + std::string(name);
}

std::string Key::allowed() const {
  const std::string range = range_of(*this);
  if (!choices.empty()) return range;
  const std::string in_unit = range + " (" + std::string(unit) + ")";
  return std::visit(Overloaded{[&](const int*) { return "a whole number from " + in_unit; },
                               [&](const double*) { return "a number from " + in_unit; },
                               [&](const auto*) { return range; }},
                    member);
}

std::string Key::statement() const {
  const Value value =
      std::visit(Overloaded{[](const int* number) { return Value(std::int64_t{*number}); },
                            [](const auto* other) { return Value(*other); }},
                 member);
  return "Default " + in_words(value) + "; unit: " + std::string(unit) +
         "; range: " + range_of(*this) + "; origin: " + std::string(origin) + ".";
}

std::string Key::assign(const Value& value) const {
  const bool taken = std::visit([&](auto* target) { return take(*target, value, *this); }, member);
  return taken ? std::string() : full_name() + " = " + in_words(value) + "; expected " + allowed();
}

}  // namespace lumibox::config
