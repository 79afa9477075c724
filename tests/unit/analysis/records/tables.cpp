// Reference: RFC 4180 and the identity: a table that is written reads back to the same bits.

#include "analysis/records/tables.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

enum class Ending { finished, not_finite };

template <>
struct analysis::EnumNames<Ending> {
    static constexpr std::array<std::pair<Ending, const char*>, 2> table{
        {{Ending::finished, "finished"}, {Ending::not_finite, "not_finite"}}};
};

namespace tables_tests {
namespace {

using analysis::CsvTable;
using analysis::parse_csv;

using test_support::refusal_of;

double round_trip(double value)
{
    CsvTable table{{"x"}};
    table.add_row({value});
    return parse_csv(table.text(), "m.csv").number(0, "x");
}

TEST(CsvTable, NumbersRoundTripToTheBit)
{
    using limits = std::numeric_limits<double>;
    std::vector<double> values = {1.0 / 3.0, limits::denorm_min() * 12345, 1e22, 123456789.0};
    for (const double value :
         {0.0, 0.1, limits::min(), limits::denorm_min(), limits::max(), limits::epsilon(), limits::infinity()})
        values.insert(values.end(), {value, -value});
    std::mt19937_64 random(3);
    while (values.size() < 2000) {
        const double value = std::bit_cast<double>(random());
        if (!std::isnan(value)) values.push_back(value);
    }
    for (double value : values)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(round_trip(value)), std::bit_cast<std::uint64_t>(value)) << value;
    EXPECT_TRUE(std::isnan(round_trip(limits::quiet_NaN())));
    EXPECT_TRUE(std::isnan(round_trip(-limits::quiet_NaN())));
}

TEST(CsvTable, NumbersAreTheShortestText)
{
    const double nan = std::nan("");
    for (const auto& [number, text] :
         {std::pair(0.1, "0.1"), {-0.25, "-0.25"}, {nan, "nan"}, {-nan, "nan"}, {-INFINITY, "-inf"}})
        EXPECT_EQ(analysis::number_text(number), text);
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

TEST(CsvTable, WritesAndReadsTypedCells)
{
    CsvTable table{{"scene", "frame", "volume_change_pct", "error_l2_pct"}}, empty{{"x"}};
    table.add_row({"limb", 3, -0.25, std::nullopt});
    EXPECT_EQ(table.text(), "scene,frame,volume_change_pct,error_l2_pct\nlimb,3,-0.25,\n");
    EXPECT_THROW(table.add_row({1}), std::logic_error) << "a mistake of the caller";
    empty.add_row({""});
    EXPECT_EQ(parse_csv(empty.text(), "m.csv").rows(), 1) << "a single empty field is not lost";
    EXPECT_EQ(parse_csv("a,b\r\n1,2\r\n", "m.csv").number(0, "b"), 2.0) << "line ends of Windows";

    const CsvTable read = parse_csv("a,b\n1,\n2.5,x\n", "m.csv");
    EXPECT_EQ(read.integer(0, "a"), 1);
    EXPECT_EQ(read.numbers("a"), (std::vector<double>{1.0, 2.5}));
    EXPECT_FALSE(read.number_or_nothing(0, "b"));
    EXPECT_TRUE(read.has_column("a"));
    EXPECT_FALSE(read.has_column("c"));
}

TEST(CsvTable, WrongValuesAreNamedWithFileLineColumn)
{
    const CsvTable table = parse_csv("a,b\n\"1\n2\",3\n4,5x\n", "m.csv");
    EXPECT_EQ(refusal_of([&] { table.number(1, "b"); }), "m.csv:4:2: b = 5x: expected a number");
    EXPECT_THROW(table.integer(1, "b"), pbs::InputError);
    EXPECT_THROW(table.number(0, "missing"), pbs::InputError);
    EXPECT_THROW(parse_csv("a\n1.5\n", "m.csv").integer(0, "a"), pbs::InputError);
    EXPECT_THROW(parse_csv("a\n 1\n", "m.csv").number(0, "a"), pbs::InputError);
}

TEST(CsvTable, BrokenFilesAreRefusedWithFileLineColumn)
{
    const std::vector<std::pair<std::string, const char*>> broken = {
        {"", "m.csv: the file is empty: expected a line of column names"},
        {"a,b\n1,2\n3,4", "m.csv:3:2: the file ends within a line: cut off?"},
        {"a,b\n1,2\n3\n", "m.csv:3:1: 1 fields: expected 2 as in the first line"},
        {"a,b\n1,2,3\n", "m.csv:2:3: 3 fields: expected 2 as in the first line"},
        {"a,b\n\n", "m.csv:2:1: 1 fields: expected 2 as in the first line"},
        {"a,a\n", "m.csv:1:2: column = a: expected each column once"},
        {"a,b\n1,\"2\n3,4\n", "m.csv:2:2: a quote is never closed"},
        {"a,b\n1,2\"\n", "m.csv:2:2: unexpected quote or zero byte within a field"},
        {"a,b\n1,\"2\"x\n", "m.csv:2:2: unexpected text after a field"},
        {std::string("a,b\n1,\0\n", 8), "m.csv:2:2: unexpected quote or zero byte within a field"},
        {"a,b\r1,2\r", "m.csv:1:2: unexpected text after a field"}};
    for (const auto& [text, message] : broken) EXPECT_EQ(refusal_of([&] { parse_csv(text, "m.csv"); }), message);
}

TEST(CsvTable, AppendsTheRowsOfOthersUnderOneHeadAndGoesThroughAFile)
{
    CsvTable all{{}};
    all.append(parse_csv("a,b\n1,\"x,y\"\n", "first.csv"));
    all.append(parse_csv("a,b\n", "none.csv"));
    all.append(parse_csv("a,b\n2,\n3,z\n", "second.csv"));
    for (const char* other : {"b,a\n1,2\n", "a\n1\n"})
        EXPECT_THROW(all.append(parse_csv(other, "other.csv")), pbs::InputError) << other;
    EXPECT_EQ(all.text(), "a,b\n1,\"x,y\"\n2,\n3,z\n");
    EXPECT_FALSE(all.number_or_nothing(1, "b"));
    EXPECT_THROW(all.number(2, "b"), pbs::InputError);  // the error names its line as well
    const test_support::ScratchFolder folder;
    const std::string path = folder / "table.csv";
    CsvTable table{{"a"}};
    table.add_row({0.1});
    table.write(path);
    EXPECT_EQ(analysis::read_csv(path).number(0, "a"), 0.1);
    EXPECT_THROW(analysis::read_csv(folder / "missing.csv"), pbs::InputError);
}

// Operations on tables as values. Reference: the definition, on a table that is read at a glance.

CsvTable times()
{
    return parse_csv("method,pose,ms\npbs,bend,3\nlbs,bend,0.50\npbs,twist,\nlbs,twist,1e0\n", "times.csv");
}

TEST(TableAsAValue, SelectsGroupsAndFindsRowsInTheirOrder)
{
    const CsvTable table = times();
    EXPECT_EQ(table.where("method", "lbs").text(), "method,pose,ms\nlbs,bend,0.50\nlbs,twist,1e0\n");
    EXPECT_EQ(table.where([](const CsvTable::Row& row) { return row.text("ms").empty(); }).rows(), 1);
    const std::vector<CsvTable> methods = table.groups({"method"});
    ASSERT_EQ(methods.size(), 2u);
    EXPECT_EQ(methods[0].map([](const CsvTable::Row& row) { return row.text("pose"); }),
              (std::vector<std::string>{"bend", "twist"}));
    EXPECT_EQ(methods[1][0].text("method"), "lbs");
    EXPECT_EQ(table.groups({"method", "pose"}).size(), 4u);
    EXPECT_EQ(table.find({{"method", "pbs"}, {"pose", "bend"}}).value().line(), 2);
    EXPECT_EQ(methods[1].by("pose").at("twist").number("ms"), 1.0);
    EXPECT_EQ(table.rows(), 4) << "the table itself stays as it was";
}

TEST(TableAsAValue, ComparesNumbersAsNumbersAndTextsAsTexts)
{
    const CsvTable table = times();
    EXPECT_EQ(table.where("ms", 0.5).rows(), 1) << "0.50 in the file";
    EXPECT_EQ(table.where("ms", 1).rows(), 1) << "1e0 in the file";
    EXPECT_EQ(table.where("ms", "0.5").rows(), 0);
    EXPECT_EQ(table.where("ms", std::nullopt).rows(), 1) << "an empty cell";
    EXPECT_EQ(table.where("ms", 0).rows(), 0) << "an empty cell is no number";
    EXPECT_EQ(table.where("method", 3.0).rows(), 0) << "nor is a text";
    EXPECT_EQ(parse_csv("x\nnan\n", "m.csv").where("x", std::nan("")).rows(), 1) << "by its name";
}

TEST(TableAsAValue, AnEmptyCellIsNoNumberAndNotLost)
{
    const CsvTable pbs = times().where("method", "pbs");
    EXPECT_EQ(pbs.known_numbers("ms"), std::vector<double>{3.0});
    EXPECT_EQ(pbs[1].number_or_nothing("ms"), std::nullopt);
    EXPECT_EQ(pbs[1].value<std::optional<int>>("ms"), std::nullopt);
    EXPECT_EQ(refusal_of([&] { pbs.numbers("ms"); }), "times.csv:4:3: ms: expected a number");
}

TEST(TableAsAValue, WhatIsNotANumberIsRefusedWithTheLineInItsFile)
{
    const CsvTable lbs = times().where("method", "lbs");
    EXPECT_EQ(refusal_of([&] { lbs[1].number("pose"); }), "times.csv:5:2: pose = twist: expected a number");
    EXPECT_EQ(refusal_of([&] { lbs[0].value<int>("ms"); }), "times.csv:3:3: ms = 0.50: expected a whole number");
}

TEST(TableAsAValue, WithoutRowsHasEveryOperation)
{
    const CsvTable none({"method", "ms"}, "times.csv");
    EXPECT_EQ(none.where("method", "pbs").text(), "method,ms\n");
    EXPECT_TRUE(none.groups({"method"}).empty());
    EXPECT_TRUE(none.by("method").empty());
    EXPECT_FALSE(none.find({{"method", "pbs"}}));
    EXPECT_TRUE(none.numbers("ms").empty());
    EXPECT_TRUE(none.map([](const CsvTable::Row& row) { return row.line(); }).empty());
    EXPECT_THROW(none[0], std::out_of_range);
}

// Even where no row would have shown the mistake.
TEST(TableAsAValue, AMissingColumnIsRefusedByTheNamesOfTheTableAndTheColumn)
{
    const CsvTable none({"method", "ms"}, "times.csv");
    const std::string message = "times.csv:1: columns = method,ms: expected a column methd";
    EXPECT_EQ(refusal_of([&] { none.where("methd", "pbs"); }), message);
    EXPECT_EQ(refusal_of([&] { none.find({{"methd", "pbs"}}); }), message);
    EXPECT_EQ(refusal_of([&] { none.groups({"methd"}); }), message);
    EXPECT_EQ(refusal_of([&] { none.by("methd"); }), message);
    EXPECT_EQ(refusal_of([&] { none.numbers("methd"); }), message);
    EXPECT_EQ(refusal_of([&] { none.known_numbers("methd"); }), message);
    CsvTable written = none;
    try {
        written.add({{"method", "pbs"}, {"seconds", 1.0}});
        FAIL() << "a mistake of the caller";
    } catch (const std::logic_error& error) {
        EXPECT_STREQ(error.what(), "times.csv: there is no column seconds");
    }
    EXPECT_EQ(written.rows(), 0);
    written.add({{"ms", 0.5}});
    EXPECT_EQ(written.text(), "method,ms\n,0.5\n");
    EXPECT_EQ(refusal_of([&] { written[0].number("method"); }), "times.csv:2:1: method: expected a number");
}

TEST(TableAsAValue, ARowThatIsThereTwiceIsRefusedWithBothLines)
{
    const CsvTable table = times();
    EXPECT_EQ(refusal_of([&] { table.by("method"); }),
              "times.csv:4:1: method = pbs: expected it once: line 2 has it too");
    EXPECT_EQ(refusal_of([&] {
                  table.find({{"method", "lbs"}});
              }),
              "times.csv:5:1: method = lbs: expected one such row: line 3 has it too");
}

TEST(TableAsAValue, ARowOutlivesItsTable)
{
    const CsvTable::Row row = times().where("pose", "bend").find({{"method", "lbs"}}).value();
    EXPECT_EQ(row.number("ms"), 0.5);
    EXPECT_TRUE(row.has({{"method", "lbs"}, {"ms", 0.5}}));
    EXPECT_FALSE(row.has({{"method", "lbs"}, {"ms", 0.25}}));
}

TEST(TableAsAValue, WritesOptionsAndValuesThatMayBeMissing)
{
    CsvTable table({"ending", "error_pct", "frame", "is_masked"});
    table.add_row({Ending::not_finite, std::optional<double>(), std::optional(3), true});
    EXPECT_EQ(table.text(), "ending,error_pct,frame,is_masked\nnot_finite,,3,1\n");
    EXPECT_EQ(table[0].value<Ending>("ending"), Ending::not_finite);
    EXPECT_TRUE(table[0].value<bool>("is_masked"));
    EXPECT_TRUE(table[0].has({{"ending", Ending::not_finite}, {"error_pct", std::optional<double>()}}));
}

// Reference: RFC 4180 and the identity: rows that are written read back unchanged.

using analysis::Columns;

struct Place {
    std::string body;
    double height_m = 0.0;
    bool operator==(const Place&) const = default;
};
struct Row {
    int frame = 0;
    Place place;
    bool is_masked = false;
    Ending ending = Ending::finished;
    std::optional<double> error_pct;
    bool operator==(const Row&) const = default;
};

const Columns<Place> place_columns = {{"body", &Place::body, "", "name of the body"},
                                      {"height_m", &Place::height_m, "m", "height above the ground"}};
const Columns<Row> row_columns =
    Columns<Row>{{"frame", &Row::frame, "", "number of the frame, from 0"}} +
    analysis::within(&Row::place, place_columns) +
    Columns<Row>{{"is_masked", &Row::is_masked, "", "the reference meets itself"},
                 {"ending", &Row::ending, "", "how it ended"}} +
    Columns<Row>{{"error_pct", &Row::error_pct, "%", "error against the reference"}}.in_group("reference");

const std::vector<Row> rows = {
    {0, {"man, sitting", 0.1}, true, Ending::not_finite, 0.25},
    {1, {"limb", std::numeric_limits<double>::infinity()}, false, Ending::finished, std::nullopt}};

std::string message_of_rows(const std::string& text)
{
    return refusal_of([&] { rows_of(row_columns, parse_csv(text, "m.csv")); });
}

TEST(TypedTable, RowsAreWrittenUnderTheirColumnsNamesAndReadBackAsTheyWere)
{
    const std::string text =
        "frame,body,height_m,is_masked,ending,error_pct\n0,\"man, "
        "sitting\",0.1,1,not_finite,0.25\n1,limb,inf,0,finished,\n";
    EXPECT_EQ(table_of(row_columns, rows).text(), text);
    EXPECT_EQ(rows_of(row_columns, parse_csv(text, "m.csv")), rows);
    EXPECT_EQ(rows_of(place_columns, parse_csv("more,height_m,body\n7,0.5,limb\n", "m.csv")),
              (std::vector<Place>{{"limb", 0.5}}))
        << "by name in any order";
    EXPECT_EQ(row_columns[3].name, "is_masked");
    EXPECT_EQ(row_columns[3].unit, "0/1");
    const Columns<Place> of_members = MEMBER_COLUMNS(Place, height_m, body);
    EXPECT_EQ(of_members.names(), (std::vector<std::string>{"height_m", "body"}));
    EXPECT_EQ(rows_of(of_members, parse_csv("height_m,body\n0.5,limb\n", "m.csv")),
              (std::vector<Place>{{"limb", 0.5}}));
}

TEST(TypedTable, AListOfNamesIsOneCell)
{
    using Names = std::vector<std::string>;
    const Columns<Names> columns = {{"names", std::identity{}, "", "names without spaces"}};
    const std::vector<Names> lists = {{"pbs", "delta_mush"}, {}, {"xpbd"}};
    EXPECT_EQ(table_of(columns, lists).text(), "names\npbs delta_mush\n\"\"\nxpbd\n");
    const std::vector<Names> with_columns =
        rows_of(columns, parse_csv("other,names\n1,pbs delta_mush\n2,\n3,xpbd\n", "m.csv"));
    EXPECT_EQ(with_columns, lists);
}

TEST(TypedTable, AGroupIsThereAsAWholeOrNotAtAll)
{
    const Columns<Row> unasked = row_columns.without("reference");
    EXPECT_EQ(table_of(unasked, rows).columns().back(), "ending");
    std::vector<Row> without_errors = rows;
    without_errors[0].error_pct.reset();
    EXPECT_EQ(rows_of(row_columns, parse_csv(table_of(unasked, rows).text(), "m.csv")), without_errors);

    const Columns<Place> both = place_columns.in_group("place");
    EXPECT_THROW(rows_of(both, parse_csv("body\nlimb\n", "m.csv")), pbs::InputError);
    EXPECT_EQ(rows_of(both, parse_csv("other\nx\n", "m.csv")), std::vector<Place>(1));
}

struct Pose {
    int frame = 0;
    std::optional<Place> place;
};
const Columns<Pose> pose_columns = Columns<Pose>{{"frame", &Pose::frame, "", "number of the frame, from 0"}} +
                                   analysis::within(&Pose::place, place_columns);

TEST(TypedTable, APartThatARowLacksHasEmptyCells)
{
    const std::string text = "frame,body,height_m\n0,limb,0.5\n1,,\n";
    EXPECT_EQ(table_of(pose_columns, std::vector<Pose>{{0, Place{"limb", 0.5}}, {1, std::nullopt}}).text(), text);
    const auto read = rows_of(pose_columns, parse_csv(text, "m.csv"));
    EXPECT_EQ(read[0].place, (Place{"limb", 0.5}));
    EXPECT_FALSE(read[1].place);
}

TEST(TypedTable, WrongCellsAreNamedWithFileLineColumnValueAndRule)
{
    const std::string head = "frame,body,height_m,is_masked,ending,error_pct\n";
    EXPECT_EQ(message_of_rows(head + "0.5,limb,1,0,finished,\n"), "m.csv:2:1: frame = 0.5: expected a whole number");
    EXPECT_EQ(message_of_rows(head + "3000000000,limb,1,0,finished,\n"),
              "m.csv:2:1: frame = 3000000000: expected a whole number of at most 31 bits");
    EXPECT_EQ(message_of_rows(head + "0,limb,high,0,finished,\n"), "m.csv:2:3: height_m = high: expected a number");
    EXPECT_EQ(message_of_rows(head + "0,limb,1,0,finished,\n1,limb,1,true,finished,\n"),
              "m.csv:3:4: is_masked = true: expected 0 or 1");
    EXPECT_EQ(message_of_rows(head + "0,limb,1,0,ended,\n"),
              "m.csv:2:5: ending = ended: expected one of finished, not_finite");
    EXPECT_EQ(message_of_rows(head + "0,limb,1,0,finished,none\n"), "m.csv:2:6: error_pct = none: expected a number");
    EXPECT_EQ(message_of_rows("frame\n0\n"), "m.csv:1: columns = frame: expected a column body");
}

TEST(TypedTable, AColumnsNameEndsWithItsUnit)
{
    using Names = std::vector<std::pair<std::string, std::string>>;
    const Names right = {
        {"time_s", "s"},         {"volume_change_pct", "%"}, {"speed_m_s", "m/s"},  {"stiffness_n_m", "N/m"},
        {"frames_per_s", "1/s"}, {"step_ms_median", "ms"},   {"step_ms_ratio", ""}, {"frame", ""}};
    const Names wrong = {{"time_s", "ms"},       {"time_s", ""},          {"time", "s"},      {"speed_m_s", "s"},
                         {"stiffness_n_m", "m"}, {"step_ms_median", "s"}, {"frame", "frames"}};
    for (const auto& [name, unit] : right) EXPECT_NO_THROW(analysis::require_unit(name, unit)) << name;
    for (const auto& [name, unit] : wrong) EXPECT_THROW(analysis::require_unit(name, unit), std::logic_error) << name;
}

}  // namespace
}  // namespace tables_tests
