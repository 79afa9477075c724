// Reference: RFC 4180 and the identity: rows that are written read back unchanged.
#include "analysis/records/typed_table.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

namespace {

enum class Ending { finished, not_finite };

}  // namespace

template <>
struct analysis::EnumNames<Ending> {
    static constexpr std::array<std::pair<Ending, const char*>, 2> table{
        {{Ending::finished, "finished"}, {Ending::not_finite, "not_finite"}}};
};

namespace {

using analysis::Columns;
using analysis::parse_csv;

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
    Columns<Row>{{"frame", &Row::frame, "", "number of the frame, from 0"}} + analysis::within(&Row::place, place_columns) +
    Columns<Row>{{"is_masked", &Row::is_masked, "", "the reference meets itself"}, {"ending", &Row::ending, "", "how it ended"}} +
    Columns<Row>{{"error_pct", &Row::error_pct, "%", "error against the reference"}}.in_group("reference");

const std::vector<Row> rows = {{0, {"man, sitting", 0.1}, true, Ending::not_finite, 0.25},
                               {1, {"limb", std::numeric_limits<double>::infinity()}, false, Ending::finished, std::nullopt}};

std::string message_of(const std::string& text)
{
    try {
        rows_of(row_columns, parse_csv(text, "m.csv"));
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(TypedTable, RowsAreWrittenUnderTheirColumnsNames)
{
    EXPECT_EQ(table_of(row_columns, rows).text(),
              "frame,body,height_m,is_masked,ending,error_pct\n"
              "0,\"man, sitting\",0.1,1,not_finite,0.25\n"
              "1,limb,inf,0,finished,\n");
}

TEST(TypedTable, RowsReadBackAsTheyWere)
{
    EXPECT_EQ(rows_of(row_columns, parse_csv(table_of(row_columns, rows).text(), "m.csv")), rows);
}

TEST(TypedTable, AListOfNamesIsOneCell)
{
    using Names = std::vector<std::string>;
    const Columns<Names> columns = {{"names", std::identity{}, "", "names without spaces"}};
    const std::vector<Names> lists = {{"pbs", "delta_mush"}, {}, {"xpbd"}};
    EXPECT_EQ(table_of(columns, lists).text(), "names\npbs delta_mush\n\"\"\nxpbd\n");
    const std::vector<Names> with_columns = rows_of(columns, parse_csv("other,names\n1,pbs delta_mush\n2,\n3,xpbd\n", "m.csv"));
    EXPECT_EQ(with_columns, lists);
}

TEST(TypedTable, ColumnsAreReadByNameInAnyOrder)
{
    const auto read = rows_of(place_columns, parse_csv("more,height_m,body\n7,0.5,limb\n", "m.csv"));
    EXPECT_EQ(read, (std::vector<Place>{{"limb", 0.5}}));
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
const Columns<Pose> pose_columns =
    Columns<Pose>{{"frame", &Pose::frame, "", "number of the frame, from 0"}} + analysis::within(&Pose::place, place_columns);

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
    EXPECT_EQ(message_of(head + "0.5,limb,1,0,finished,\n"), "m.csv:2:1: frame = 0.5: expected a whole number");
    EXPECT_EQ(message_of(head + "3000000000,limb,1,0,finished,\n"),
              "m.csv:2:1: frame = 3000000000: expected a whole number of at most 31 bits");
    EXPECT_EQ(message_of(head + "0,limb,high,0,finished,\n"), "m.csv:2:3: height_m = high: expected a number");
    EXPECT_EQ(message_of(head + "0,limb,1,0,finished,\n1,limb,1,true,finished,\n"), "m.csv:3:4: is_masked = true: expected 0 or 1");
    EXPECT_EQ(message_of(head + "0,limb,1,0,ended,\n"), "m.csv:2:5: ending = ended: expected one of finished, not_finite");
    EXPECT_EQ(message_of(head + "0,limb,1,0,finished,none\n"), "m.csv:2:6: error_pct = none: expected a number");
    EXPECT_EQ(message_of("frame\n0\n"), "m.csv:1: columns = frame: expected a column body");
}

TEST(TypedTable, AFlagIsZeroOrOne)
{
    EXPECT_EQ(row_columns[3].name, "is_masked");
    EXPECT_EQ(row_columns[3].unit, "0/1");
}

TEST(TypedTable, AColumnsNameEndsWithItsUnit)
{
    for (const auto& [name, unit] : std::vector<std::pair<std::string, std::string>>{{"time_s", "s"},
                                                                                     {"volume_change_pct", "%"},
                                                                                     {"speed_m_s", "m/s"},
                                                                                     {"stiffness_n_m", "N/m"},
                                                                                     {"frames_per_s", "1/s"},
                                                                                     {"step_ms_median", "ms"},
                                                                                     {"step_ms_ratio", ""},
                                                                                     {"frame", ""}})
        EXPECT_NO_THROW(analysis::require_unit(name, unit)) << name;
    for (const auto& [name, unit] : std::vector<std::pair<std::string, std::string>>{{"time_s", "ms"},
                                                                                     {"time_s", ""},
                                                                                     {"time", "s"},
                                                                                     {"speed_m_s", "s"},
                                                                                     {"stiffness_n_m", "m"},
                                                                                     {"step_ms_median", "s"},
                                                                                     {"frame", "frames"}})
        EXPECT_THROW(analysis::require_unit(name, unit), std::logic_error) << name;
}

}  // namespace
