#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lumibox::lightfield {

/// A value in a JSON file that knows where it stands, so that whatever is wrong with it can be said
/// in one line: "capture/transforms.json: frames[3].file_path is a number, expected text".
/// All functions throw config::InputError with such a line. Refers into its JsonFile.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, const std::filesystem::path& file, std::string where)
      : json_(&json), file_(&file), where_(std::move(where)) {}

  bool has(const std::string& key) const { return json_->is_object() && json_->contains(key); }
  JsonValue at(const std::string& key) const;             ///< member of an object; must exist
  std::vector<JsonValue> items() const;                   ///< of an array
  double number() const;                                  ///< finite
  long long integer(long long min, long long max) const;  ///< 540.0 counts as an integer
  bool boolean() const;
  std::string text() const;
  Eigen::VectorXd numbers(int count) const;  ///< an array of that many numbers

  double number_or(const std::string& key, double fallback) const {
    return has(key) ? at(key).number() : fallback;
  }

  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void fail_type(const char* expected) const;

  const nlohmann::json* json_;
  const std::filesystem::path* file_;
  std::string where_;
};

/// A JSON file, parsed. Throws config::InputError with the line of a syntax error.
class JsonFile {
 public:
  explicit JsonFile(const std::filesystem::path& path);
  JsonValue root() const { return {json_, path_, ""}; }

 private:
  std::filesystem::path path_;
  nlohmann::json json_;
};

}  // namespace lumibox::lightfield
