// Truth: the definitions of the figures, and the claims' own rules for whether a verdict changes.
#include "experiments/studies/ambiguity/ambiguity_table.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::AmbiguityTable;
using experiments::Reading;
using experiments::ReadMotion;

// A clip of 100 frames with one vertex at x [m].
ReadMotion motion_of(double change_pct, double x)
{
    ReadMotion moved;
    for (auto* record : {&moved.pbs, &moved.lbs}) {
        record->scene = "walk";
        for (int frame = 0; frame < 100; ++frame) {
            record->frame.push_back(frame);
            record->time_s.push_back(0.2 * frame);
            record->volume_change_pct.push_back(change_pct);
            record->volume_abs_change_pct.push_back(2.0 * std::abs(change_pct));
            record->inverted_tets.push_back(0.0);
        }
    }
    moved.pbs.deformer = "pbs";
    moved.pbs.iterations = 24;
    moved.lbs.deformer = "lbs";
    for (int frame = 0; frame < 100; ++frame) moved.shapes.push_back((pbs::Positions(1, 3) << x, 0, 0).finished());
    return moved;
}

analysis::CsvTable compared(const ReadMotion& a, const ReadMotion& b)
{
    experiments::Scene scene;
    scene.name = "walk";
    AmbiguityTable table;
    table.add(scene, Reading{.place = "Eq. 2", .name = "B", .baseline = "A", .options = {}}, a, b, a, {});
    return table.table();
}

double figure(const analysis::CsvTable& table, const std::string& name, const std::string& column)
{
    for (int row = 0; row < table.rows(); ++row)
        if (table.text_at(row, "figure") == name) return table.number(row, column);
    ADD_FAILURE() << name;
    return 0.0;
}

TEST(AmbiguityTable, HasTheFiguresOfBothAndTheirChange)
{
    const auto table = compared(motion_of(-0.25, 0.0), motion_of(-0.75, 0.5));
    EXPECT_EQ(figure(table, "mean volume change [%]", "a"), -0.25);
    EXPECT_EQ(figure(table, "mean volume change [%]", "b"), -0.75);
    EXPECT_EQ(figure(table, "mean volume change [%]", "change"), -0.5);
    EXPECT_EQ(figure(table, "mean absolute volume change [%]", "b"), 1.5);
    EXPECT_EQ(figure(table, "share of frames within 0.5 %", "a"), 1.0);
    EXPECT_EQ(figure(table, "share of frames within 0.5 %", "b"), 0.0);
    EXPECT_EQ(figure(table, "distance of B from A, rms [m]", "b"), 0.5);
}

TEST(AmbiguityTable, SaysWhereAVerdictChangesAndWhereNot)
{
    const auto changed = compared(motion_of(-0.25, 0.0), motion_of(-0.75, 0.0));
    EXPECT_EQ(changed.text_at(0, "verdict_changed").substr(0, 44), "C02 by volume_change_pct: whole -> nowhere; ");
    EXPECT_EQ(compared(motion_of(-0.1, 0.0), motion_of(-0.2, 0.0)).text_at(0, "verdict_changed"), "no");
    EXPECT_EQ(compared(motion_of(-11.0, 0.0), motion_of(-14.0, 0.0)).text_at(0, "verdict_changed").substr(0, 22), "C01 by volume_loss_pct");
}

}  // namespace
