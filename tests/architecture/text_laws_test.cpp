// Reference: the project's rules on text. Planted violations have one letter by its code, so that this file itself obeys the law.
#include "tests/architecture/expect_lawful.hpp"
#include "tests/architecture/text_laws.hpp"

using namespace architecture;

TEST(TextLaws, NoPathOfOneMachine)
{
    expect_lawful(absolute_paths);
}
TEST(TextLaws, NoUnfinishedMarks)
{
    expect_lawful(unfinished_marks);
}
TEST(TextLaws, NoStrayWhitespace)
{
    expect_lawful(stray_whitespace);
}

TEST(TextLawsBite, HomeFolder)
{
    expect_found(absolute_paths, {{"analysis/x.cpp", "\n// see /\150ome/somebody/data\n"}}, "analysis/x.cpp:2");
}

TEST(TextLawsBite, UnfinishedMark)
{
    expect_found(unfinished_marks, {{"analysis/x.cpp", "// \124ODO later\n"}}, "analysis/x.cpp:1: finish it");
}

TEST(TextLawsBite, Whitespace)
{
    expect_found(stray_whitespace, {{"a.md", "tab\there\nclean\n"}}, "a.md:1");
    expect_found(stray_whitespace, {{"a.md", "clean\nblank \n"}}, "a.md:2");
}
