#include "config/schema.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "config/loader.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::config {
namespace {

std::vector<Key> numbers(Config& config) {
  std::vector<Key> keys;
  for (const Key& key : schema(config)) {
    if (!std::holds_alternative<std::string*>(key.member) &&
        !std::holds_alternative<bool*>(key.member) && key.choices.empty()) {
      keys.push_back(key);
    }
  }
  return keys;
}

double number_in(const Key& key) {
  if (const auto* whole = std::get_if<int*>(&key.member)) {
    return **whole;
  }
  return *std::get<double*>(key.member);
}

TEST(Schema, DefaultsAreAllowed) {
  Config config;
  for (const Key& key : schema(config)) {
    if (const auto* text = std::get_if<std::string*>(&key.member)) {
      EXPECT_EQ(key.assign(std::string(**text)), "");
    } else if (const auto* whole = std::get_if<int*>(&key.member)) {
      EXPECT_EQ(key.assign(std::int64_t{**whole}), "");
    } else if (const auto* real = std::get_if<double*>(&key.member)) {
      EXPECT_EQ(key.assign(**real), "");
    }
  }
}

TEST(Schema, KeysAndMembersAreThereOnce) {
  Config config;
  std::set<std::string> names;
  std::set<const void*> members;
  for (const Key& key : schema(config)) {
    EXPECT_TRUE(names.insert(key.full_name()).second) << key.full_name();
    const void* member = std::visit([](auto* m) -> const void* { return m; }, key.member);
    EXPECT_TRUE(members.insert(member).second) << key.full_name();
  }
}

// A member added to config.h alone could never be set: every one of them has a key.
TEST(Schema, EveryMemberInTheHeaderHasAKey) {
  const std::string header =
      testing::read_text(std::string(LUMIBOX_SOURCE_DIR) + "/config/config.h");
  const std::regex structure(R"(struct (\w+) \{([^}]*)\};)");
  const std::regex member(R"(\n  (?:int|double|bool|std::string) (\w+))");
  std::multiset<std::string> in_header;
  for (std::sregex_iterator s(header.begin(), header.end(), structure), end; s != end; ++s) {
    const std::string body = (*s)[2];
    for (std::sregex_iterator m(body.begin(), body.end(), member); m != end; ++m) {
      in_header.insert((*m)[1]);
    }
  }
  Config config;
  std::multiset<std::string> in_schema;
  for (const Key& key : schema(config)) {
    in_schema.emplace(key.name);
  }
  EXPECT_EQ(in_schema, in_header);
}

RC_GTEST_PROP(SchemaProperty, NumbersInRangeComeBackFromAFile, (const std::uint32_t draw)) {
  Config written;
  const std::vector<Key> keys = numbers(written);
  const auto index = *rc::gen::inRange<std::size_t>(0, keys.size());
  const Key& key = keys[index];
  const double share = draw / 4294967295.0;
  const double target = key.min + share * (key.max - key.min);
  const bool whole = std::holds_alternative<int*>(key.member);
  const double number = whole ? std::round(target) : target;

  std::ostringstream text;
  text.precision(17);
  text << '[' << key.section << "]\n" << key.name << " = " << number << '\n';
  // The two bounds of the capture threshold limit each other.
  if (key.name == "threshold_min_deg") text << "threshold_max_deg = 90.0\n";
  if (key.name == "threshold_max_deg") text << "threshold_min_deg = 0.1\n";
  const testing::TempDir folder;
  Config read = load({.system_file = {}, .file = folder.write("a.toml", text.str())});
  RC_ASSERT(number_in(numbers(read)[index]) == number);
}

RC_GTEST_PROP(SchemaProperty, NumbersOutOfRangeAreRefusedAndLeaveTheMember,
              (const std::uint32_t draw, bool below)) {
  Config config;
  const std::vector<Key> keys = numbers(config);
  const Key& key = keys[*rc::gen::inRange<std::size_t>(0, keys.size())];
  const double before = number_in(key);
  const double beyond = 1e-6 + draw;
  const double number = below ? key.min - beyond : key.max + beyond;
  const std::string fault =
      std::holds_alternative<int*>(key.member)
          ? key.assign(static_cast<std::int64_t>(below ? std::floor(number) : std::ceil(number)))
          : key.assign(number);
  RC_ASSERT(fault.find(key.full_name()) != std::string::npos);
  RC_ASSERT(fault.find(key.allowed()) != std::string::npos);
  RC_ASSERT(number_in(key) == before);
}

}  // namespace
}  // namespace lumibox::config
