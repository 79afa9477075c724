// C04, C05 and C06 are judged from what the study of artefacts measures: alter its figures and the verdicts turn round. Truth: the
// project's own claims.toml; the figures are made up, in the form that the study writes them.
#include "analysis/verdict.hpp"

#include "analysis/atomic_file.hpp"
#include "analysis/claims.hpp"
#include "analysis/measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::Measurement;
using analysis::VerdictKind;

analysis::Claim claim_of(const std::string& id)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    return *std::find_if(claims.begin(), claims.end(), [&](const analysis::Claim& claim) { return claim.id == id; });
}

VerdictKind verdict(const std::string& id, const std::vector<Measurement>& measured)
{
    analysis::Records records;
    records.measurements = measured;
    return judge(claim_of(id), records).kind;
}

Measurement figure(const std::string& id, const std::string& quantity, double value)
{
    return {id, quantity, "limb, twist 90 deg, upper|forearm", value, value, value, "1"};
}

TEST(ArtefactsVerdict, AThinSectionIsACandyWrapper)
{
    std::vector<Measurement> measured = {figure("C04", "smallest section radius over rest", 0.97),
                                         figure("C04", "smallest section area over rest", 0.98),
                                         figure("C04", "smallest section area over rest, lbs", 0.0)};
    EXPECT_EQ(verdict("C04", measured), VerdictKind::reproduced);
    measured[1].low = 0.5;
    EXPECT_EQ(verdict("C04", measured), VerdictKind::reproduced_only_for);
    measured[0].value = measured[0].low = 0.3;
    measured[1].value = 0.2;
    EXPECT_EQ(verdict("C04", measured), VerdictKind::not_reproduced);
}

TEST(ArtefactsVerdict, AWideSectionIsABulge)
{
    std::vector<Measurement> measured = {figure("C05", "largest section radius over the reference's", 1.01),
                                         figure("C05", "largest section area over the reference's", 1.02),
                                         figure("C05", "largest section area over the reference's, dqs", 2.0)};
    EXPECT_EQ(verdict("C05", measured), VerdictKind::reproduced);
    measured[0].value = measured[0].high = 1.06;
    EXPECT_EQ(verdict("C05", measured), VerdictKind::reproduced_only_for);
    measured[1].value = measured[1].high = 1.2;
    EXPECT_EQ(verdict("C05", measured), VerdictKind::not_reproduced);
}

TEST(ArtefactsVerdict, ARatioAboveOneIsNotSmoother)
{
    std::vector<Measurement> measured = {figure("C06", "strain jump at the joint of PBS, Eq. 2 over rigid", 0.7),
                                         figure("C06", "strain jump at the joint of LBS, Eq. 2 over rigid", 0.4),
                                         figure("C06", "curvature of the skin of PBS, Eq. 2 over rigid", 9.0)};
    EXPECT_EQ(verdict("C06", measured), VerdictKind::reproduced);
    measured[0].high = 1.1;
    EXPECT_EQ(verdict("C06", measured), VerdictKind::reproduced_only_for);
    measured[0].value = measured[1].value = 1.1;
    EXPECT_EQ(verdict("C06", measured), VerdictKind::not_reproduced);
}

TEST(ArtefactsVerdict, NothingMeasuredIsNoVerdict)
{
    EXPECT_EQ(verdict("C04", {}), VerdictKind::not_computable);
    EXPECT_EQ(verdict("C05", {figure("C04", "smallest section area over rest", 1.0)}), VerdictKind::not_computable);
}

}  // namespace
