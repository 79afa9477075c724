// Reference: numbers and words by hand.
#include "experiments/meshes/text_words.hpp"

#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using pbs::TextWords;

TEST(NumberIn, ReadsWhatCFortranAndPythonWrite)
{
    for (const auto& [word, number] : {std::pair{"0.29", 0.29},
                                       {"+0.29", 0.29},
                                       {"2.9D-01", 0.29},
                                       {"-2.9d-1", -0.29},
                                       {"2.9E-01", 0.29},
                                       {".29", 0.29},
                                       {"3.", 3.0},
                                       {"1e-320", 1e-320}})
        EXPECT_EQ(pbs::number_in(word), number) << word;
    EXPECT_TRUE(std::isnan(pbs::number_in("nan").value()));
    EXPECT_EQ(pbs::number_in("-inf"), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(pbs::number_in("1e999"), std::numeric_limits<double>::infinity());
    for (const char* word : {"", "+", "1.#QNAN", "1,5", "0.29x", "D-01", "east", "1.5.2", "2.9D"})
        EXPECT_FALSE(pbs::number_in(word)) << word;
}

TEST(AsUtf8, LeavesOutTheByteOrderMarkAndConvertsUtf16)
{
    EXPECT_EQ(pbs::as_utf8("\xEF\xBB\xBFv 1"), "v 1");
    EXPECT_EQ(pbs::as_utf8(std::string("\xFF\xFEv\0 \0\x31\0", 8)), "v 1");
    EXPECT_EQ(pbs::as_utf8(std::string("\xFE\xFF\0v\0 \0\x31", 8)), "v 1");
    // U+00E9, U+20AC and U+1D11E: two, three and four bytes
    EXPECT_EQ(pbs::as_utf8(std::string("\xFF\xFE\xE9\0\xAC\x20\x34\xD8\x1E\xDD", 10)),
              "\xC3\xA9\xE2\x82\xAC\xF0\x9D\x84\x9E");
    for (const std::string text : {"", "v 1", "\xC3\xA9", "\xFF"}) EXPECT_EQ(pbs::as_utf8(text), text);
}

TEST(TextWords, SkipCommentsAndKeepTextsInQuotationMarksWhole)
{
    TextWords words("a.mesh", "# first\n\tone \"two words # and no comment\" #three\r\n 4", '#');
    EXPECT_EQ(words.next("a"), "one");
    EXPECT_EQ(words.next("b"), "\"two words # and no comment\"");
    EXPECT_EQ(words.whole("c", 0, 9), 4);
    EXPECT_TRUE(words.at_end());
}

TEST(TextWords, NameFileLineFieldValueAndRule)
{
    TextWords words("a.msh", "1\n2 x 7");
    EXPECT_EQ(words.number("one"), 1.0);
    expect_input_error([&] { words.whole("two", 5, 9); }, "a.msh:2: two = 2: ", "expected a whole number from 5 to 9");
    expect_input_error([&] { words.number("x [m]"); }, "a.msh:2: x [m] = x: ", "expected a number");
    words.next("seven");
    expect_input_error([&] { words.next("last"); }, "a.msh:2: last: ", "truncated: the file ends here");
}

}  // namespace
