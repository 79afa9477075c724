// C01 and C02 are judged from metrics.csv, frame by frame: if the frames of one body are altered, the verdicts change. Reference: the
// project's own claims.toml; the frames are invented.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/claims.hpp"
#include "analysis/verdicts/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::VerdictKind;

// 200 frames of a clip around a mean change.
analysis::CaseRecord clip(const std::string& scene, const std::string& deformer, double change_pct)
{
    analysis::CaseRecord record;
    record.scene = scene;
    record.deformer = deformer;
    record.variant = "default";
    record.iterations = deformer == "pbs" ? 24 : 0;
    for (int frame = 0; frame < 200; ++frame) {
        record.frame.push_back(frame);
        record.time_s.push_back(0.04 * frame);
        record.volume_change_pct.push_back(change_pct * (1.0 + 0.05 * (frame % 5 - 2)));
        record.volume_abs_change_pct.push_back(std::abs(record.volume_change_pct.back()));
        record.inverted_tets.push_back(0.0);
    }
    return record;
}

VerdictKind verdict(const std::string& id, const std::vector<analysis::CaseRecord>& cases)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    const auto claim = std::find_if(claims.begin(), claims.end(), [&](const auto& one) { return one.id == id; });
    analysis::Records records;
    records.cases = cases;
    return judge(*claim, records).kind;
}

TEST(VolumeVerdict, FourteenPerCentIsAMeanLoss)
{
    EXPECT_EQ(verdict("C01", {clip("man_01_01", "lbs", -14.0), clip("lady_01_01", "lbs", -13.0)}), VerdictKind::reproduced);
    EXPECT_EQ(verdict("C01", {clip("man_01_01", "lbs", -14.0), clip("frankie_01_01", "lbs", -8.0)}), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict("C01", {clip("man_01_01", "lbs", -6.0), clip("lady_01_01", "lbs", 6.0)}), VerdictKind::not_reproduced);
}

TEST(VolumeVerdict, HalfAPerCentIsHeldByEveryBodyOrNotByAll)
{
    EXPECT_EQ(verdict("C02", {clip("man_01_01", "pbs", -0.3), clip("lady_01_01", "pbs", 0.3)}), VerdictKind::reproduced);
    EXPECT_EQ(verdict("C02", {clip("man_01_01", "pbs", -0.3), clip("lady_01_01", "pbs", -2.0)}), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict("C02", {clip("man_01_01", "pbs", -1.0), clip("lady_01_01", "pbs", -2.0)}), VerdictKind::not_reproduced);
}

}  // namespace
