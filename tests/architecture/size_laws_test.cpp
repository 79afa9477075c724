// Truth: the house sizes, measured on codes of the field that are easy to enter.
#include "tests/architecture/expect_lawful.hpp"
#include "tests/architecture/size_laws.hpp"

using namespace architecture;

namespace {

std::string lines(int count)
{
    std::string text;
    for (int i = 0; i < count; ++i) text += "    line();\n";
    return text;
}

}  // namespace

TEST(SizeLaws, Files)
{
    expect_lawful(file_sizes);
}
TEST(SizeLaws, Functions)
{
    expect_lawful(function_sizes);
}

TEST(SizeLawsBite, FileOver500Lines)
{
    SourceTree planted = {{"analysis/long.cpp", lines(501)}};
    for (int i = 0; i < 9; ++i) planted["analysis/short" + std::to_string(i) + ".cpp"] = lines(100);
    expect_found(file_sizes, planted, "analysis/long.cpp:1: file of 501 lines");
}

TEST(SizeLawsBite, MoreThanOneInTenAbove200)
{
    expect_found(file_sizes, {{"analysis/x.cpp", lines(201)}}, "more than 1 in 10");
}

TEST(SizeLawsBite, FunctionOver60Lines)
{
    expect_found(function_sizes, {{"analysis/x.cpp", "int f()\n{\n" + lines(60) + "}\n"}}, "analysis/x.cpp:1: function of 62 lines");
}

TEST(SizeLawsBite, MethodInAClass)
{
    expect_found(function_sizes, {{"analysis/x.hpp", "class A {\n    int f()\n    {\n" + lines(60) + "    }\n};\n"}},
                 "function of 62 lines");
}

TEST(SizeLawsBite, ShortFunctionPasses)
{
    EXPECT_TRUE(function_sizes({{"analysis/x.cpp", "int f()\n{\n" + lines(10) + "}\n"}}).empty());
}
