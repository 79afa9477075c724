// Reference: the sizes in well-regarded codes of the field.
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

TEST(SizeLaws, Lines)
{
    expect_lawful(line_lengths);
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

TEST(SizeLawsBite, LineOver140Columns)
{
    for (const char* path : {"analysis/x.cpp", "analysis/x.hpp", "tests/x.py", "cmake/x.cmake", "pbs/CMakeLists.txt", "cmake/x.sh", "check",
                             "paper_figures/x.js", "tests/x.mjs", "paper_figures/x.css", "experiments/sweeps/Snakefile"})
        expect_found(line_lengths, {{path, "\n" + std::string(141, 'x') + "\n"}}, std::string(path) + ":2: 141 columns, at most 140");
}

TEST(SizeLawsBite, LineOf140ColumnsPasses)
{
    std::string umlauts;
    for (int i = 0; i < 140; ++i) umlauts += "\u00fc";
    EXPECT_TRUE(line_lengths({{"analysis/x.cpp", std::string(140, 'x') + "\n" + umlauts + "\n"}}).empty());
    EXPECT_TRUE(line_lengths({{"README.md", std::string(141, 'x')}, {"package-lock.json", std::string(141, 'x')}}).empty());
}

TEST(SizeLawsBite, ShortFunctionPasses)
{
    EXPECT_TRUE(function_sizes({{"analysis/x.cpp", "int f()\n{\n" + lines(10) + "}\n"}}).empty());
}
