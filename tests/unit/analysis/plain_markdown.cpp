// Reference: the definition, on small texts.
#include "analysis/plain_markdown.hpp"

#include <gtest/gtest.h>

using namespace analysis;

TEST(PlainMarkdown, FillsParagraphsAndLeavesOutCommentsAndLinks)
{
    EXPECT_EQ(plain_text("# A title\n\nOne [page](../page.md) has\n`code` in it.\n\n<!-- kept:begin -->\n\n## Next\n", 20),
              "A title\n\nOne page has code in\nit.\n\nNext\n");
}

TEST(PlainMarkdown, IndentsItems)
{
    EXPECT_EQ(plain_text("- one two three four\n  five\n- six\n1. seven\n", 16), "-  one two three\n   four five\n-  six\n1.  seven\n");
}

TEST(PlainMarkdown, KeepsCodeUnlessItIsTooLong)
{
    EXPECT_EQ(plain_text("    a  =  b\n    c = d (and more)\n", 14), "    a  =  b\nc = d (and\nmore)\n");
}

TEST(PlainMarkdown, SetsTablesInColumns)
{
    EXPECT_EQ(plain_text("| a | b |\n|---|---|\n| 1 | two words |\n\nend\n", 30), "a  b\n1  two words\n\nend\n");
    EXPECT_EQ(plain_text("| a | b |\n|---|---|\n| 1 | two words |\n", 9), "a  b\n1  two\n   words\n");
}

TEST(PlainMarkdown, FindsTheFirstParagraph)
{
    EXPECT_EQ(first_paragraph("# volume\n\nHow much\nis lost?\n\nMore.\n"), "How much is lost?");
}
