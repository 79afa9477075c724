// Reference: TOML's grammar, https://toml.io/en/v1.0.0: bare keys are ASCII; texts, comments and lists hold any number of dots.
#include "pbs/geometry/toml_text.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

std::string repeated(const std::string& before, int count, const std::string& text, const std::string& after)
{
    std::string all = before;
    for (int i = 0; i < count; ++i) all += text;
    return all += after;
}

std::string message_of(const std::string& text)
{
    try {
        pbs::check_toml_keys(text, "x.toml");
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(TomlText, KeysOfManyPartsAreNamedWithTheirLine)
{
    const std::string head = "# a key\n", told = "x.toml:2: key = ";
    for (const std::string part : {"a.", "\"a\".", "'a'.", "a . ", "\"a\\\".\"."})
        for (const std::string before : {"", "[", "[["}) {
            const std::string text = repeated(head + before, 64, part, "a = 1\n");
            EXPECT_EQ(message_of(text).substr(0, told.size()), told) << text;
        }
    EXPECT_EQ(message_of(repeated("", 63, "a.", "a = 1\n")), "accepted");
}

TEST(TomlText, KeysOfInlineTablesAreCountedWithThoseAroundThem)
{
    const std::string told = "x.toml:1: key = x = ";
    for (const std::string before : {"x = {", "x = { b = 1, ", "x = [1, {", "x = [{ b = { c = 2 }, ", "x = { b = \"{#\", 'c' = '}', "})
        EXPECT_EQ(message_of(repeated(before, 64, "a.", "a = 1}\n")).substr(0, told.size()), told) << before;
    EXPECT_EQ(message_of(repeated("x = ", 8, "{a.a.a.a.a.a.a.a.a = ", "1\n")).substr(0, told.size()), told);
    EXPECT_EQ(message_of(repeated("x = [", 100, "{ a.b = 0.5, c.d = { e.f = 0.5 } }, ", "]\n")), "accepted");
    EXPECT_EQ(message_of(repeated("x = [\n", 100, "{ a.b = 0.5 },\n", "]\n")), "accepted");
}

TEST(TomlText, QuotesOfManyLinesHideNoKey)
{
    const std::string told = "x.toml:3: key = ";
    for (const std::string text : {"x = [\"\"\"\n\"\n\"\"\"\", ", "x = ['''\n'\n''''', ", "x = \"\"\n\n["})
        EXPECT_EQ(message_of(repeated(text + "{", 64, "a.", "a = 1}]\n")).substr(0, told.size()), told) << text;
    EXPECT_EQ(message_of(repeated("x = \"\"\"\n\"\n\\\"\"\"", 100, "a.", "\n\"\"\"\"\"\n")), "accepted");
}

TEST(TomlText, DotsElsewhereAreNoParts)
{
    EXPECT_EQ(message_of(repeated("x = \"", 100, "a.", "\"\n")), "accepted");
    EXPECT_EQ(message_of(repeated("# ", 100, "a.", "\n")), "accepted");
    EXPECT_EQ(message_of(repeated("x = [\n", 100, "0.5, ", "\n]\n")), "accepted");
    EXPECT_EQ(message_of(repeated("\"", 100, "a.", "\" = 1\n")), "accepted");  // a single part, whose name contains dots
}

TEST(TomlText, BareWordsAreAscii)
{
    EXPECT_EQ(message_of("x = 1\nt\xc3\xa9te = 2\n"), "x.toml:2: byte = 195: expected ASCII outside of texts");
    EXPECT_EQ(message_of(std::string("x\0y = 2\n", 8)), "x.toml:1: byte = 0: expected ASCII outside of texts");
    EXPECT_EQ(message_of("x = \"\"\"\n\"\"\"\nt\xc3\xa9te = 2\n"), "x.toml:3: byte = 195: expected ASCII outside of texts");
    EXPECT_EQ(message_of("x = r\"t\xc3\xa9te\"\n").substr(0, 18), "x.toml:1: quote = ");
    EXPECT_EQ(message_of("x = \"t\xc3\xa9te\"  # t\xc3\xa9te\r\n\ty = 2\r\n"), "accepted");
}

}  // namespace
