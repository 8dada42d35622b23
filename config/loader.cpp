#include "config/loader.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <sstream>

#include "config/error.h"
#include "config/input_file.h"
#include "config/schema.h"
#include "config/suggestion.h"

namespace lumibox::config {
namespace {

namespace fs = std::filesystem;
using Keys = std::vector<Key>;

int line_of(const toml::source_region& source) {
  return static_cast<int>(source.begin.line);
}

toml::table parse(const fs::path& file) {
  try {
    return toml::parse(read_text(file), file.string());
  } catch (const toml::parse_error& error) {
    throw InputError(file, line_of(error.source()), std::string(error.description()));
  }
}

/// "unknown key 'x'; did you mean 'y'? Allowed: ..."
std::string unknown(const std::string& what, const std::string& name,
                    const std::vector<std::string>& allowed) {
  const std::string meant = nearest(name, allowed);
  std::string message = "unknown " + what + " '" + name +
                        (meant.empty() ? "'. " : "'; did you mean '" + meant + "'? ") + "Allowed: ";
  for (const std::string& candidate : allowed) {
    message += (&candidate == &allowed.front() ? "" : ", ") + candidate;
  }
  return message;
}

std::vector<std::string> names_in(const Keys& keys, std::string_view section) {
  std::vector<std::string> names;
  for (const Key& key : keys) {
    if (key.section == section) {
      names.emplace_back(key.name);
    }
  }
  return names;
}

std::vector<std::string> sections_of(const Keys& keys) {
  std::vector<std::string> sections;
  for (const Key& key : keys) {
    if (std::ranges::find(sections, key.section) == sections.end()) {
      sections.emplace_back(key.section);
    }
  }
  return sections;
}

const Key* find(const Keys& keys, std::string_view section, std::string_view name) {
  const auto found = std::ranges::find_if(
      keys, [&](const Key& key) { return key.section == section && key.name == name; });
  return found == keys.end() ? nullptr : &*found;
}

/// None if the node is a table, an array or a date, which no key takes.
std::optional<Value> value_of(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return Value(flag->get());
  if (const auto* whole = node.as_integer()) return Value(std::int64_t{whole->get()});
  if (const auto* real = node.as_floating_point()) return Value(real->get());
  if (const auto* text = node.as_string()) return Value(text->get());
  return std::nullopt;
}

void read_key(const toml::key& name, const toml::node& node, std::string_view section,
              const Keys& keys, const fs::path& file) {
  const int line = line_of(name.source());
  const Key* key = find(keys, section, name.str());
  if (key == nullptr) {
    const std::string where = section.empty() ? "key" : "key in [" + std::string(section) + "]";
    throw InputError(file, line, unknown(where, std::string(name), names_in(keys, section)));
  }
  const std::optional<Value> value = value_of(node);
  const std::string fault =
      value ? key->assign(*value) : key->full_name() + ": expected " + key->allowed();
  if (!fault.empty()) {
    throw InputError(file, line, fault);
  }
}

void read_config_file(const fs::path& file, const Keys& keys) {
  const toml::table root = parse(file);
  const std::vector<std::string> sections = sections_of(keys);
  for (const auto& [section, node] : root) {
    const int line = line_of(section.source());
    if (std::ranges::find(sections, section.str()) == sections.end()) {
      throw InputError(file, line, unknown("section", std::string(section), sections));
    }
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      throw InputError(
          file, line,
          std::string(section) + " is a section; expected [" + std::string(section) + "]");
    }
    for (const auto& [name, value] : *table) {
      read_key(name, value, section.str(), keys, file);
    }
  }
}

template <typename Number>
std::optional<Value> whole_text_as(const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, number);
  return status == std::errc() && stop == end ? std::optional<Value>(number) : std::nullopt;
}

/// The text of a command line as the kind of value that the key takes.
Value value_for(const Key& key, const std::string& text) {
  if (std::holds_alternative<std::string*>(key.member)) {
    return text;
  }
  if (text == "true" || text == "false") {
    return text == "true";
  }
  if (const auto whole = whole_text_as<std::int64_t>(text)) {
    return *whole;
  }
  return whole_text_as<double>(text).value_or(text);
}

void apply_assignment(const std::string& assignment, const Keys& keys) {
  const std::string where = "--set " + assignment + ": ";
  const std::size_t equals = assignment.find('=');
  const std::size_t dot = assignment.substr(0, equals).find('.');
  if (equals == std::string::npos || dot == std::string::npos) {
    throw InputError(where + "expected section.key=value");
  }
  const std::string section = assignment.substr(0, dot);
  const std::string name = assignment.substr(dot + 1, equals - dot - 1);
  const Key* key = find(keys, section, name);
  if (key == nullptr) {
    std::vector<std::string> all;
    std::ranges::transform(keys, std::back_inserter(all), &Key::full_name);
    throw InputError(where + unknown("key", section + "." + name, all));
  }
  const std::string fault = key->assign(value_for(*key, assignment.substr(equals + 1)));
  if (!fault.empty()) {
    throw InputError(where + fault);
  }
}

/// What no single key can know.
void check_together(const Config& config) {
  if (config.capture.threshold_min_deg > config.capture.threshold_max_deg) {
    throw InputError("config: capture.threshold_min_deg is above capture.threshold_max_deg");
  }
}

}  // namespace

Config load(const Sources& sources) {
  Config config;
  const Keys keys = schema(config);
  std::error_code ignored;
  if (fs::exists(sources.system_file, ignored)) {
    read_config_file(sources.system_file, keys);
  }
  if (sources.file) {
    read_config_file(*sources.file, keys);
  }
  for (const std::string& assignment : sources.assignments) {
    apply_assignment(assignment, keys);
  }
  check_together(config);
  return config;
}

CameraProfile load_camera_profile(const fs::path& file) {
  ProfileFile found;
  const Keys keys = schema(found);
  const toml::table root = parse(file);
  for (const auto& [name, node] : root) {
    read_key(name, node, "", keys, file);
  }
  for (const char* required : {"width", "height", "fx", "fy", "cx", "cy"}) {
    if (!root.contains(required)) {
      throw InputError(file, std::string("no key '") + required + "'; a camera profile needs it");
    }
  }
  found.profile.model = found.model == "fisheye" ? LensModel::Fisheye : LensModel::Opencv;
  if (const std::optional<std::string> fault = fault_of(found.profile)) {
    throw InputError(file, *fault);
  }
  return found.profile;
}

std::string profile_text(const CameraProfile& profile) {
  ProfileFile file{profile, name_of(profile.model)};
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  for (const Key& key : schema(file)) {
    text << key.name << " = ";
    if (const auto* word = std::get_if<std::string*>(&key.member)) {
      text << '"' << **word << "\"\n";
    } else if (const auto* whole = std::get_if<int*>(&key.member)) {
      text << **whole << '\n';
    } else {
      text << *std::get<double*>(key.member) << '\n';
    }
  }
  return text.str();
}

}  // namespace lumibox::config
