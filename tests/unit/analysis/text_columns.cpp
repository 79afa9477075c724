// Reference: the definition. No line is longer than requested, every word is there and in order, and columns begin at the same position.
#include "analysis/text_columns.hpp"

#include <gtest/gtest.h>

namespace {

using namespace analysis;

TEST(TextColumns, BreaksBetweenWords)
{
    EXPECT_EQ(wrapped("one two three", 7), (std::vector<std::string>{"one two", "three"}));
    EXPECT_EQ(wrapped("one two three", 6), (std::vector<std::string>{"one", "two", "three"}));
    EXPECT_TRUE(wrapped("", 6).empty());
}

TEST(TextColumns, BreaksAWordThatIsLonger)
{
    EXPECT_EQ(wrapped("a abcdefgh", 3), (std::vector<std::string>{"a", "abc", "def", "gh"}));
}

TEST(TextColumns, KeepsLineBreaks)
{
    EXPECT_EQ(wrapped("one\ntwo", 20), (std::vector<std::string>{"one", "two"}));
}

TEST(TextColumns, CountsCharactersNotBytes)
{
    EXPECT_EQ(characters("90\u00b0 \u2264"), 5u);
    EXPECT_EQ(wrapped("\u2264\u2264 \u2264\u2264", 5), (std::vector<std::string>{"\u2264\u2264 \u2264\u2264"}));
    EXPECT_EQ(wrapped("\u2264\u2264\u2264", 2), (std::vector<std::string>{"\u2264\u2264", "\u2264"}));
}

TEST(TextColumns, ColumnsBeginAtTheSamePlace)
{
    EXPECT_EQ(side_by_side({{"a", 2}, {"\u2264 and more", 5}, {"end of it", 6}}), "a   \u2264 and  end of\n    more   it\n");
}

TEST(TextColumns, AColourTakesNoRoom)
{
    EXPECT_EQ(side_by_side({{"a b", 1, "\033[31m"}, {"c", 1}}), "\033[31ma\033[0m  c\n\033[31mb\033[0m\n");
}

}  // namespace
