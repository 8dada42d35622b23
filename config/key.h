#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lumibox::config {

/// A value as a file or a command line gives it.
using Value = std::variant<bool, std::int64_t, double, std::string>;

/// One key of a file: where it stands, which member it sets and what that member may be.
struct Key {
  std::string_view section;  ///< empty at the top level
  std::string_view name;
  std::variant<bool*, int*, double*, std::string*> member;
  std::string_view unit;
  double min = 0.0;  ///< smallest and largest number allowed; of text, min 1 forbids none
  double max = 0.0;
  std::vector<std::string_view> choices;  ///< of text, or of whole numbers within the range
  std::string_view origin;                ///< why the default is what it is

  std::string full_name() const;  ///< section.name

  /// What is allowed, for a person: "a whole number from 2 to 6 (levels)".
  std::string allowed() const;

  /// Default, unit, range and origin in one line, as lumibox.toml has it above the key. The default
  /// is what the member holds now.
  std::string statement() const;

  /// Sets the member, or says what is wrong with the value and leaves the member as it was.
  [[nodiscard]] std::string assign(const Value& value) const;
};

}  // namespace lumibox::config
