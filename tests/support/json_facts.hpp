// Compares a record with those of its values that a test states.
//   expect_facts(record, R"({"model": "linear", "bones": [{"samples": 7720}, {}]})");
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace test_support {

// Objects may have more values than `expected`; a list with objects has as many elements, each of which is compared in
// the same way.
inline void expect_facts(const nlohmann::json& actual, const nlohmann::json& expected, const std::string& place)
{
    const auto is_object = [](const nlohmann::json& value) { return value.is_object(); };
    if (!expected.is_object() && std::none_of(expected.begin(), expected.end(), is_object)) {
        EXPECT_EQ(actual, expected) << place;
        return;
    }
    if (actual.is_array()) {
        ASSERT_EQ(actual.size(), expected.size()) << place;
    }
    for (const auto& [key, value] : expected.items())
        expect_facts(actual.is_array() ? actual.at(std::stoul(key)) : actual.at(key), value, place + "/" + key);
}

inline void expect_facts(const nlohmann::json& actual, const std::string& expected)
{
    expect_facts(actual, nlohmann::json::parse(expected), "");
}

}  // namespace test_support
