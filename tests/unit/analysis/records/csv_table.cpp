// Reference: RFC 4180 and the identity: a table that is written reads back to the same bits.
#include "analysis/records/csv_table.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace {

using analysis::CsvTable;
using analysis::parse_csv;

std::string message_of(const std::string& text)
{
    try {
        parse_csv(text, "m.csv");
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "accepted";
}

double round_trip(double value)
{
    CsvTable table{{"x"}};
    table.add_row({value});
    return parse_csv(table.text(), "m.csv").number(0, "x");
}

TEST(CsvTable, NumbersRoundTripToTheBit)
{
    using limits = std::numeric_limits<double>;
    std::vector<double> values = {0.0,
                                  -0.0,
                                  0.1,
                                  -1.0 / 3.0,
                                  limits::min(),
                                  limits::denorm_min(),
                                  -limits::denorm_min() * 12345,
                                  limits::max(),
                                  limits::lowest(),
                                  limits::epsilon(),
                                  limits::infinity(),
                                  -limits::infinity(),
                                  1e22,
                                  123456789.0};
    std::mt19937_64 random(3);
    while (values.size() < 2000) {
        const double value = std::bit_cast<double>(random());
        if (!std::isnan(value)) values.push_back(value);
    }
    for (double value : values) EXPECT_EQ(std::bit_cast<std::uint64_t>(round_trip(value)), std::bit_cast<std::uint64_t>(value)) << value;
    EXPECT_TRUE(std::isnan(round_trip(limits::quiet_NaN())));
    EXPECT_TRUE(std::isnan(round_trip(-limits::quiet_NaN())));
}

TEST(CsvTable, NumbersAreTheShortestText)
{
    EXPECT_EQ(analysis::number_text(0.1), "0.1");
    EXPECT_EQ(analysis::number_text(-0.25), "-0.25");
    EXPECT_EQ(analysis::number_text(std::nan("")), "nan");
    EXPECT_EQ(analysis::number_text(-std::nan("")), "nan");
    EXPECT_EQ(analysis::number_text(-INFINITY), "-inf");
}

TEST(CsvTable, TextOfATable)
{
    CsvTable table{{"scene", "frame", "volume_change_pct", "error_l2_pct"}};
    table.add_row({"limb", 3, -0.25, std::nullopt});
    EXPECT_EQ(table.text(), "scene,frame,volume_change_pct,error_l2_pct\nlimb,3,-0.25,\n");
}

TEST(CsvTable, QuotedFieldsRoundTrip)
{
    const std::vector<std::string> fields = {"plain", "with,comma", "with \"quotes\"", "two\nlines", "cr\r\nlf",
                                             "",      "\"",         " spaces ",        "\xc3\xa4"};
    CsvTable table{{"a,b", "line\nbreak"}};
    for (const auto& field : fields) table.add_row({field, field});
    const CsvTable read = parse_csv(table.text(), "m.csv");
    EXPECT_EQ(read.columns(), table.columns());
    ASSERT_EQ(read.rows(), static_cast<int>(fields.size()));
    for (int row = 0; row < read.rows(); ++row) {
        EXPECT_EQ(read.text_at(row, "a,b"), fields[row]);
        EXPECT_EQ(read.text_at(row, "line\nbreak"), fields[row]);
    }
}

TEST(CsvTable, SingleEmptyFieldIsNotLost)
{
    CsvTable table{{"x"}};
    table.add_row({""});
    EXPECT_EQ(parse_csv(table.text(), "m.csv").rows(), 1);
}

TEST(CsvTable, ReadsWindowsLineEnds)
{
    const CsvTable table = parse_csv("a,b\r\n1,2\r\n", "m.csv");
    EXPECT_EQ(table.number(0, "b"), 2.0);
}

TEST(CsvTable, TypedAccess)
{
    const CsvTable table = parse_csv("a,b\n1,\n2.5,x\n", "m.csv");
    EXPECT_EQ(table.integer(0, "a"), 1);
    EXPECT_EQ(table.numbers("a"), (std::vector<double>{1.0, 2.5}));
    EXPECT_FALSE(table.number_or_nothing(0, "b"));
    EXPECT_TRUE(table.has_column("a"));
    EXPECT_FALSE(table.has_column("c"));
}

TEST(CsvTable, WrongValuesAreNamedWithFileLineColumn)
{
    const CsvTable table = parse_csv("a,b\n\"1\n2\",3\n4,5x\n", "m.csv");
    try {
        table.number(1, "b");
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_STREQ(error.what(), "m.csv:4:2: b = 5x: expected a number");
    }
    EXPECT_THROW(table.integer(1, "b"), pbs::InputError);
    EXPECT_THROW(table.number(0, "missing"), pbs::InputError);
    EXPECT_THROW(parse_csv("a\n1.5\n", "m.csv").integer(0, "a"), pbs::InputError);
    EXPECT_THROW(parse_csv("a\n 1\n", "m.csv").number(0, "a"), pbs::InputError);
}

TEST(CsvTable, BrokenFilesAreRefusedWithFileLineColumn)
{
    EXPECT_EQ(message_of(""), "m.csv: the file is empty: expected a line of column names");
    EXPECT_EQ(message_of("a,b\n1,2\n3,4"), "m.csv:3:2: the file ends within a line: cut off?");
    EXPECT_EQ(message_of("a,b\n1,2\n3\n"), "m.csv:3:1: 1 fields: expected 2 as in the first line");
    EXPECT_EQ(message_of("a,b\n1,2,3\n"), "m.csv:2:3: 3 fields: expected 2 as in the first line");
    EXPECT_EQ(message_of("a,b\n\n"), "m.csv:2:1: 1 fields: expected 2 as in the first line");
    EXPECT_EQ(message_of("a,a\n"), "m.csv:1:2: column = a: expected each column once");
    EXPECT_EQ(message_of("a,b\n1,\"2\n3,4\n"), "m.csv:2:2: a quote is never closed");
    EXPECT_EQ(message_of("a,b\n1,2\"\n"), "m.csv:2:2: unexpected quote or zero byte within a field");
    EXPECT_EQ(message_of("a,b\n1,\"2\"x\n"), "m.csv:2:2: unexpected text after a field");
    EXPECT_EQ(message_of(std::string("a,b\n1,\0\n", 8)), "m.csv:2:2: unexpected quote or zero byte within a field");
    EXPECT_EQ(message_of("a,b\r1,2\r"), "m.csv:1:2: unexpected text after a field");
}

TEST(CsvTable, RowsOfAnotherLengthAreAMistakeOfTheCaller)
{
    CsvTable table{{"a", "b"}};
    EXPECT_THROW(table.add_row({1}), std::logic_error);
}

TEST(CsvTable, AppendsTheRowsOfOthersUnderOneHead)
{
    CsvTable all{{}};
    all.append(parse_csv("a,b\n1,\"x,y\"\n", "first.csv"));
    all.append(parse_csv("a,b\n", "none.csv"));
    all.append(parse_csv("a,b\n2,\n3,z\n", "second.csv"));
    EXPECT_EQ(all.text(), "a,b\n1,\"x,y\"\n2,\n3,z\n");
    EXPECT_FALSE(all.number_or_nothing(1, "b"));
    EXPECT_THROW(all.number(2, "b"), pbs::InputError);  // the error names its line as well
}

TEST(CsvTable, AppendsNoTableOfOtherColumns)
{
    CsvTable all = parse_csv("a,b\n1,2\n", "first.csv");
    EXPECT_THROW(all.append(parse_csv("b,a\n1,2\n", "other.csv")), pbs::InputError);
    EXPECT_THROW(all.append(parse_csv("a\n1\n", "other.csv")), pbs::InputError);
    EXPECT_EQ(all.text(), "a,b\n1,2\n");
}

TEST(CsvTable, GoesThroughAFile)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder / "table.csv";
    CsvTable table{{"a"}};
    table.add_row({0.1});
    table.write(path);
    EXPECT_EQ(analysis::read_csv(path).number(0, "a"), 0.1);
    EXPECT_THROW(analysis::read_csv(folder / "missing.csv"), pbs::InputError);
}

}  // namespace
