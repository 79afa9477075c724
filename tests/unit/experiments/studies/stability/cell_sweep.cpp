// Reference: the requirements on a sweep; a cell counts for the claim if its base and all its factors are the paper's.
#include "experiments/studies/stability/cell_sweep.hpp"

#include "experiments/deformers/registry.hpp"
#include "pbs/solver/options.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

StabilityCell pbs_cell()
{
    StabilityCell cell;
    cell.spec = default_spec("pbs");
    return cell;
}

Sweep iterations(bool as_published)
{
    return {"iterations",
            "1",
            {24.0, 1.0},
            {4.0},
            [](StabilityCell& cell, double n) { options_of<pbs::PbsOptions>(cell.spec).iterations = int(n); },
            as_published};
}

Sweep mass_ratio(bool as_published)
{
    return {"mass_ratio", "1", {10.0, 100.0}, {}, [](StabilityCell& cell, double ratio) { cell.mass_ratio = ratio; }, as_published};
}

TEST(CellSweep, HasItsValuesInOrder)
{
    const auto quick = cells_of(iterations(true), pbs_cell(), false), full = cells_of(iterations(true), pbs_cell(), true);
    ASSERT_EQ(quick.size(), 2u);
    ASSERT_EQ(full.size(), 3u);
    EXPECT_EQ(options_of<pbs::PbsOptions>(full[1].spec).iterations, 4);
    EXPECT_EQ(full[1].value, 4.0);
}

TEST(CellSweep, AMapIsAsPublishedWhereAllOfItIs)
{
    for (const bool base : {false, true})
        for (const bool rows : {false, true})
            for (const bool columns : {false, true}) {
                StabilityCell from = pbs_cell();
                from.as_published = base;
                const auto cells = cells_of_map(iterations(rows), mass_ratio(columns), from, false);
                ASSERT_EQ(cells.size(), 4u);
                for (const StabilityCell& cell : cells) EXPECT_EQ(cell.as_published, base && rows && columns);
                EXPECT_EQ(options_of<pbs::PbsOptions>(cells[1].spec).iterations, 1);
                EXPECT_EQ(cells[1].mass_ratio, 100.0);
            }
}

// --resume compares to_json; setting_of identifies shared undisturbed states.
TEST(CellSweep, ARecordTellsWhatACellStandsForAndItsSettingDoesNot)
{
    StabilityCell cell = cells_of_map(iterations(true), mass_ratio(true), pbs_cell(), false).front();
    const auto expect_on_record_alone = [&](auto change) {
        StabilityCell changed = cell;
        change(changed);
        EXPECT_NE(to_json(changed), to_json(cell));
        EXPECT_EQ(setting_of(changed), setting_of(cell));
    };
    expect_on_record_alone([](StabilityCell& of) { of.as_published = !of.as_published; });
    expect_on_record_alone([](StabilityCell& of) { of.unit = std::string("s"); });
    expect_on_record_alone([](StabilityCell& of) { of.second_factor = std::string("twist"); });
    expect_on_record_alone([](StabilityCell& of) { of.second_unit = std::string("deg"); });
    StabilityCell elsewhere = cell;
    elsewhere.disturbance.angle_deg += 1.0;
    EXPECT_NE(setting_of(elsewhere), setting_of(cell));
}

}  // namespace
