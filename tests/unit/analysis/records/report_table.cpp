// Reference: the definitions, on small texts. No line is longer than requested, every word is there and in order, and
// columns begin at the same position.

#include "analysis/records/report_table.hpp"

#include <gtest/gtest.h>

namespace {

using namespace analysis;

TEST(TextColumns, BreakBetweenWords)
{
    struct Case {
        const char *name, *text;
        std::size_t width;
        std::vector<std::string> lines;
    };
    const std::vector<Case> all = {
        {"lines of the width", "one two three", 7, {"one two", "three"}},
        {"one character less", "one two three", 6, {"one", "two", "three"}},
        {"nothing", "", 6, {}},
        {"a longer word", "a abcdefgh", 3, {"a", "abc", "def", "gh"}},
        {"line breaks are kept", "one\ntwo", 20, {"one", "two"}},
        {"characters, not bytes", "\u2264\u2264 \u2264\u2264", 5, {"\u2264\u2264 \u2264\u2264"}},
        {"a longer word of characters", "\u2264\u2264\u2264", 2, {"\u2264\u2264", "\u2264"}}};
    for (const Case& of : all) EXPECT_EQ(wrapped(of.text, of.width), of.lines) << of.name;
    EXPECT_EQ(characters("90\u00b0 \u2264"), 5u);
}

TEST(TextColumns, BeginAtTheSamePlaceAndAColourTakesNoRoom)
{
    EXPECT_EQ(side_by_side({{"a", 2}, {"\u2264 and more", 5}, {"end of it", 6}}),
              "a   \u2264 and  end of\n    more   it\n");
    EXPECT_EQ(side_by_side({{"a b", 1, "\033[31m"}, {"c", 1}}), "\033[31ma\033[0m  c\n\033[31mb\033[0m\n");
}

TEST(TextColumns, KeepThePlaceOfAnEmptyCellAndEndWithoutBlanks)
{
    EXPECT_EQ(side_by_side({{"a", 2}, {"", 3}, {"b", 1}}), "a        b\n");
    EXPECT_EQ(side_by_side({{"a", 2}, {"b", 3}, {"", 4}}), "a   b\n");
}

TEST(PlainMarkdown, IsSetForATerminal)
{
    struct Case {
        const char *name, *markdown;
        std::size_t width;
        std::string text;
    };
    const std::vector<Case> all = {
        {"paragraphs are filled, comments and links left out",
         "# A title\n\nOne [page](../page.md) has\n`code` in it.\n\n<!-- kept:begin -->\n\n## Next\n", 20,
         "A title\n\nOne page has code in\nit.\n\nNext\n"},
        {"pictures and marks of emphasis are left out, signs of multiplication are not",
         "![A picture](a.png)\n\n**C01: holds.** *Known*: the (*least*) 2 * 3, a*b, `limb_*`; upper\\|forearm\n", 80,
         "\nC01: holds. Known: the (least) 2 * 3, a*b, limb_*; upper|forearm\n"},
        {"items", "- one two three four\n  five\n- six\n1. seven\n", 16,
         "-  one two three\n   four five\n-  six\n1.  seven\n"},
        {"code is kept unless it is too long", "    a  =  b\n    c = d (and more)\n", 14,
         "    a  =  b\nc = d (and\nmore)\n"},
        {"a table", "| a | b |\n|---|---|\n| 1 | two words |\n\nend\n", 30, "a  b\n1  two words\n\nend\n"},
        {"a bar in a cell", "| x\\|y | z |\n|---|---|\n", 30, "x|y  z\n"},
        {"a narrow table", "| a | b |\n|---|---|\n| 1 | two words |\n", 9, "a  b\n1  two\n   words\n"}};
    for (const Case& of : all) EXPECT_EQ(plain_text(of.markdown, of.width), of.text) << of.name;
    EXPECT_EQ(first_paragraph("# volume\n\nHow [much](a.md)\nis *lost*?\n\nMore.\n"), "How much is lost?");
}

}  // namespace
