#include "lightfield/json_value.h"

#include <algorithm>
#include <cmath>

#include "config/error.h"
#include "config/input_file.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {

JsonValue JsonValue::at(const std::string& key) const {
  if (!json_->is_object()) fail_type("an object");
  const auto member = json_->find(key);
  const std::string where = where_.empty() ? key : where_ + "." + key;
  if (member == json_->end()) throw config::InputError(*file_, where + " is missing");
  return {*member, *file_, where};
}

std::vector<JsonValue> JsonValue::items() const {
  if (!json_->is_array()) fail_type("an array");
  std::vector<JsonValue> items;
  for (std::size_t i = 0; i < json_->size(); ++i) {
    items.emplace_back((*json_)[i], *file_, where_ + "[" + std::to_string(i) + "]");
  }
  return items;
}

double JsonValue::number() const {
  if (!json_->is_number()) fail_type("a number");
  const double value = json_->get<double>();
  if (!std::isfinite(value)) fail("is not finite");
  return value;
}

long long JsonValue::integer(long long min, long long max) const {
  const bool integral =
      json_->is_number_integer() || (json_->is_number_float() && std::trunc(number()) == number());
  // Compared as doubles first: a conversion that does not fit is undefined.
  if (integral && number() >= static_cast<double>(min) && number() <= static_cast<double>(max)) {
    const auto value = json_->get<long long>();
    if (value >= min && value <= max) return value;
  }
  fail("is " + json_->dump().substr(0, 40) + ", expected an integer from " + std::to_string(min) +
       " to " + std::to_string(max));
}

bool JsonValue::boolean() const {
  if (!json_->is_boolean()) fail_type("true or false");
  return json_->get<bool>();
}

std::string JsonValue::text() const {
  if (!json_->is_string()) fail_type("text");
  return json_->get<std::string>();
}

Eigen::VectorXd JsonValue::numbers(int count) const {
  const std::vector<JsonValue> values = items();
  if (values.size() != static_cast<std::size_t>(count)) {
    fail("has " + std::to_string(values.size()) + " numbers, expected " + std::to_string(count));
  }
  Eigen::VectorXd numbers(count);
  for (int i = 0; i < count; ++i) numbers[i] = values[static_cast<std::size_t>(i)].number();
  return numbers;
}

void JsonValue::fail(const std::string& message) const {
  throw config::InputError(*file_, where_.empty() ? message : where_ + " " + message);
}

void JsonValue::fail_type(const char* expected) const {
  const std::string found = json_->type_name();
  fail((where_.empty() ? "holds " : "is ") + found + ", expected " + expected);
}

JsonFile::JsonFile(const std::filesystem::path& path) : path_(path) {
  const std::vector<std::uint8_t> bytes = config::read_bytes(path);
  try {
    json_ = nlohmann::json::parse(bytes);
  } catch (const nlohmann::json::parse_error& error) {
    const auto end =
        bytes.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, bytes.size()));
    const auto line = 1 + std::count(bytes.begin(), end, std::uint8_t{'\n'});
    throw config::InputError(path, static_cast<int>(line), "not valid JSON");
  } catch (const nlohmann::json::exception& error) {
    throw config::InputError(path, "not valid JSON: " + printable(error.what()));
  }
}

}  // namespace lumibox::lightfield
