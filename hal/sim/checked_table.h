#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumibox::hal::sim {

struct Range {
  double min = -1e6;
  double max = 1e6;
};

/// A TOML table read key by key. Every read checks type and range; finish() refuses the keys that
/// nobody read. All errors are config::InputError with file, line, key and what is allowed.
/// A key without fallback must be there.
class CheckedTable {
 public:
  /// `name` is what errors call the table, e.g. "[camera]".
  CheckedTable(const toml::table& table, std::filesystem::path file, std::string name)
      : table_(&table), file_(std::move(file)), name_(std::move(name)) {}

  double number(std::string_view key, Range range, std::optional<double> fallback = {});
  int integer(std::string_view key, Range range, std::optional<int> fallback = {});
  std::string text(std::string_view key, std::optional<std::string> fallback = {});
  /// `count` numbers; a single number stands for `count` equal ones where `repeat` says so.
  Eigen::VectorXd numbers(std::string_view key, int count, Range range,
                          const std::optional<Eigen::VectorXd>& fallback = {});
  /// One of the names in `choices`; gives its position.
  std::size_t choice(std::string_view key, std::span<const std::string_view> choices,
                     std::optional<std::size_t> fallback = {});
  std::vector<std::string> texts(std::string_view key);
  /// A list of lists of `count` numbers; empty if the key is absent.
  std::vector<Eigen::VectorXd> rows(std::string_view key, int count, Range range);

  bool has(std::string_view key);
  std::optional<CheckedTable> table(std::string_view key);  ///< none if absent
  std::vector<CheckedTable> tables(std::string_view key);   ///< [[key]]; empty if absent

  void finish() const;

  /// Complains about a key's value (or, if the key is absent, about the table).
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;

 private:
  const toml::node* find(std::string_view key);
  std::vector<double> number_list(std::string_view key, const toml::node& node, int count,
                                  Range range) const;

  const toml::table* table_;
  std::filesystem::path file_;
  std::string name_;
  std::vector<std::string> known_;
};

}  // namespace lumibox::hal::sim
