// Reference: the form that the header specifies. The content of a file neither breaks the single line nor reaches the
// terminal as a command.

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

std::string told(const std::string& file, int line, const std::string& field, const std::string& value,
                 const std::string& rule)
{
    return pbs::InputError(file, line, field, value, rule).what();
}

TEST(InputError, IsFileLineFieldValueAndRule)
{
    EXPECT_EQ(told("limb.toml", 12, "k_volume", "1.4", "expected 0 <= k <= 1"),
              "limb.toml:12: k_volume = 1.4: expected 0 <= k <= 1");
    EXPECT_EQ(told("limb.toml", 0, "k_volume", "", "missing"), "limb.toml: k_volume: missing");
    EXPECT_EQ(told("", 0, "", "", "expected a verb"), "expected a verb");
    EXPECT_EQ(told("t\xc3\xa9te.toml", 0, "", "", "no such file"), "t\xc3\xa9te.toml: no such file");
}

TEST(InputError, ControlCharactersStandByTheirCodes)
{
    EXPECT_EQ(told("a\nb.toml", 1, "joint\t", "a\npbskin: all is well\x1b[2J", "no such joint: \x7f\r"),
              "a\\nb.toml:1: joint\\x09 = a\\npbskin: all is well\\x1b[2J: no such joint: \\x7f\\x0d");
    EXPECT_EQ(told("", 0, "joint",
                   "\xc2\x9b"
                   "2J \xc2\xa0\xc3\x9b\xc2",
                   "no such joint"),
              "joint = \\x9b"
              "2J \xc2\xa0\xc3\x9b\\xc2: no such joint");
    const std::string none = "\x82 \xc0\xaf \xed\xa0\x80 \xf4\x90\x80\x80 \xe2\x82",
                      whole = "\xe2\x82\xac \xf0\x9f\xa6\xb4";
    EXPECT_EQ(told("", 0, "v", none, whole),
              "v = \\x82 \\xc0\\xaf \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80 \\xe2\\x82: \xe2\x82\xac \xf0\x9f\xa6\xb4")
        << "no UTF-8";
    // a message that contains a message
    EXPECT_EQ(told("", 0, "", "", told("a\n", 0, "", "", "no such file")), "a\\n: no such file");
}

TEST(InputError, LongFieldsAndValuesAreCut)
{
    const std::string most(80, 'a');
    EXPECT_EQ(told("x.csv", 2, most, most, "expected a number"),
              "x.csv:2: " + most + " = " + most + ": expected a number");
    EXPECT_EQ(told("x.csv", 2, most + "b", std::string(5'000'000, 'a'), "expected a number"),
              "x.csv:2: " + most + "... = " + most + "...: expected a number");
    const std::string letters = std::string(79, 'a') + "\xc3\xa9t\xc3\xa9";
    EXPECT_EQ(told("", 0, "joint", letters, "no such joint"),
              "joint = " + letters.substr(0, 79) + "...: no such joint");
}

// Reference: the specification in input_error.hpp.

TEST(NameList, HasAtMostSixNames)
{
    EXPECT_EQ(pbs::name_list({}), "");
    EXPECT_EQ(pbs::name_list({"a"}), "a");
    EXPECT_EQ(pbs::name_list({"a", "b", "c", "d", "e", "f"}), "a, b, c, d, e, f");
    EXPECT_EQ(pbs::name_list({"a", "b", "c", "d", "e", "f", "g", "h"}), "a, b, c, d, e, f and 2 others");
}

// Reference: edit distances counted by hand.

using pbs::nearest_name;

TEST(NearestName, TakesTheLeastEditDistanceAndTheFirstOfEquals)
{
    EXPECT_EQ(nearest_name("anything", {}), "");
    EXPECT_EQ(nearest_name("tial_m", {"head_m", "tail_m", "name"}), "tail_m");
    EXPECT_EQ(nearest_name("nam", {"head_m", "tail_m", "name"}), "name");
    EXPECT_EQ(nearest_name("", {"abc", "ab", "cd"}), "ab");
    EXPECT_EQ(nearest_name("iteration", {"iterations", "precision", "order"}), "iterations");
    EXPECT_EQ(nearest_name("k_volum", {"k_stretch", "k_volume", "k_bind"}), "k_volume");
}

TEST(NearestName, ANameOfMegabytesTakesNoTime)
{
    std::string endless;
    for (int i = 0; i < 2'000'000; ++i) endless += "elbow";
    // a comparison letter by letter would take half an hour
    EXPECT_EQ(nearest_name(endless, std::vector<std::string>(1000, "shoulder")), "shoulder");
    EXPECT_EQ(nearest_name(endless, {"shoulder", "elbow", "wrist"}), "elbow");
}

}  // namespace
