// Reference: the rows of a metrics.csv with the columns of the contract.
#include "analysis/case_record.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::case_records;
using analysis::CaseRecord;
using analysis::parse_csv;

const std::string head =
    "scene,deformer,variant,order,precision,iterations,threads,frame,time_s,volume_change_pct,volume_abs_change_pct,inverted_tets";

TEST(CaseRecords, RowsAreGroupedByCase)
{
    const auto table = parse_csv(head +
                                     "\nlimb,lbs,,,,,1,0,0,0,0,0\nlimb,pbs,,ordered,f32,24,1,0,0,0,0,0\nlimb,lbs,,,,,1,1,0.01,-3,4,2\n"
                                     "limb,pbs,,ordered,f32,24,1,1,0.01,-0.1,1,0\nlimb,pbs,,plain,f64,24,1,0,0,0,0,0\n",
                                 "metrics.csv");
    const auto records = case_records(table, "volume/limb");
    ASSERT_EQ(records.size(), 3u);
    EXPECT_EQ(records[0].deformer, "lbs");
    EXPECT_EQ(records[0].iterations, 0);
    EXPECT_EQ(records[0].volume_change_pct, (std::vector<double>{0.0, -3.0}));
    EXPECT_EQ(records[0].inverted_tets, (std::vector<double>{0.0, 2.0}));
    EXPECT_EQ(records[1].iterations, 24);
    EXPECT_EQ(records[1].time_s, (std::vector<double>{0.0, 0.01}));
    EXPECT_EQ(records[1].run, "volume/limb");
    EXPECT_FALSE(records[1].is_sweep());
    EXPECT_EQ(records[2].frame.size(), 1u);
}

TEST(CaseRecords, AnglesMakeASweep)
{
    const auto table = parse_csv(
        head + ",angle_deg\nlimb,lbs,,,,0,1,0,0,0,0,0,0\nlimb,lbs,,,,0,1,1,0.01,-3,4,2,10\nwalk,lbs,,,,0,1,0,0,0,0,0,\n", "metrics.csv");
    const auto records = case_records(table, "");
    EXPECT_EQ(records[0].angle_deg, (std::vector<double>{0.0, 10.0}));
    EXPECT_FALSE(records[1].is_sweep());
}

TEST(CaseRecords, AReferencesFramesThatAreNotReachedAreLeftOutAndCounted)
{
    const auto table = parse_csv(head +
                                     ",outcome\nlimb,snh,,,,,1,0,0,0,0,0,finished\nlimb,snh,,,,,1,1,0.01,-9,9,9,not_converged\n"
                                     "limb,pbs,,plain,f32,24,1,1,0.01,-1,1,0,not_converged\n",
                                 "metrics.csv");
    const auto records = case_records(table, "");
    EXPECT_EQ(records[0].frame, (std::vector<double>{0.0}));
    EXPECT_EQ(records[0].frames_not_converged, 1);
    EXPECT_EQ(records[1].frame.size(), 1u) << "PBS above its residual still is in its pose";
}

TEST(CaseRecords, AnglesOfSomeFramesOnlyAreRefused)
{
    EXPECT_THROW(case_records(parse_csv(head + ",angle_deg\nlimb,lbs,,,,0,1,0,0,0,0,0,0\nlimb,lbs,,,,0,1,1,0.01,-3,4,2,\n", "m.csv"), ""),
                 pbs::InputError);
}

TEST(CaseRecords, MissingColumnsAreRefused)
{
    EXPECT_THROW(case_records(parse_csv("scene\nlimb\n", "m.csv"), ""), pbs::InputError);
}

TEST(MetricSeries, LossIsMinusTheSignedChange)
{
    CaseRecord record;
    record.frame = record.time_s = record.inverted_tets = {0.0, 1.0};
    record.volume_change_pct = {-3.0, 1.0};
    record.volume_abs_change_pct = {4.0, 2.0};
    EXPECT_EQ(analysis::metric_series(record, "volume_loss_pct"), (std::vector<double>{3.0, -1.0}));
    EXPECT_EQ(analysis::metric_series(record, "volume_change_pct"), record.volume_change_pct);
    EXPECT_EQ(analysis::metric_series(record, "volume_abs_change_pct"), record.volume_abs_change_pct);
    EXPECT_THROW(analysis::metric_series(record, "beauty"), pbs::InputError);
    record.time_s.pop_back();
    EXPECT_THROW(analysis::metric_series(record, "volume_loss_pct"), pbs::InputError);
}

}  // namespace
