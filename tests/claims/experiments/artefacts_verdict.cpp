// C04, C05 and C06 are judged from the values that the study of artefacts writes: if the sections and strains behind them are altered, the
// verdicts change. Reference: the project's own claims.toml.
#include "experiments/studies/artefacts/smoothness_comparison.hpp"
#include "tests/support/artefact_samples.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using analysis::Measurement;
using analysis::VerdictKind;
using experiments::ArtefactBody;
using experiments::ArtefactCase;
using experiments::ArtefactSample;
using test_support::sample;

VerdictKind verdict(const std::string& id, const std::vector<Measurement>& measured)
{
    analysis::Records records;
    records.measurements = measured;
    return judge(test_support::claim(id), records).kind;
}

void expect_the_claims_quantities(const std::string& id, const std::vector<Measurement>& measured)
{
    const analysis::Claim claim = test_support::claim(id);
    std::set<std::string> known(claim.metrics.begin(), claim.metrics.end()), written;
    for (const Measurement& measurement : measured) written.insert(measurement.quantity);
    for (const std::string& quantity : known) EXPECT_TRUE(written.contains(quantity)) << quantity;
    known.insert(claim.reported.begin(), claim.reported.end());
    for (const std::string& quantity : written) EXPECT_TRUE(known.contains(quantity)) << quantity;
}

class ArtefactsVerdict : public testing::Test {
protected:
    std::vector<Measurement> thin(const std::vector<ArtefactSample>& samples) const
    {
        return experiments::candy_wrapper_values(twisted, body, samples);
    }
    std::vector<Measurement> wide(const std::vector<ArtefactSample>& samples) const
    {
        return experiments::bulge_values(bent, body, samples);
    }

    ArtefactCase twisted = test_support::small_limb(ArtefactCase::Claim::candy_wrapper);
    ArtefactCase bent = test_support::small_limb(ArtefactCase::Claim::bulge);
    ArtefactBody body{bent};
};

TEST_F(ArtefactsVerdict, AThinSectionIsACandyWrapper)
{
    std::vector<ArtefactSample> samples = {sample("pbs", 0, 0.97), sample("pbs", 1, 0.98), sample("lbs", 0, 0.0), sample("dqs", 0, 1.0),
                                           sample("reference", 0, 1.0, 1)};
    expect_the_claims_quantities("C04", thin(samples));
    EXPECT_EQ(verdict("C04", thin(samples)), VerdictKind::reproduced);
    samples.push_back(sample("pbs", 1, 0.5));  // in another order
    EXPECT_EQ(verdict("C04", thin(samples)), VerdictKind::reproduced_only_for);
    samples[0] = sample("pbs", 0, 0.3);
    EXPECT_EQ(verdict("C04", thin(samples)), VerdictKind::not_reproduced);
}

TEST_F(ArtefactsVerdict, AWideSectionIsABulge)
{
    std::vector<ArtefactSample> samples = {sample("pbs", 0, 1.01), sample("pbs", 1, 1.02),         sample("dqs", 0, 2.0),
                                           sample("lbs", 0, 1.0),  sample("reference", 0, 1.0, 1), sample("reference", 1, 1.0, 1)};
    expect_the_claims_quantities("C05", wide(samples));
    EXPECT_EQ(verdict("C05", wide(samples)), VerdictKind::reproduced);
    samples[1] = sample("pbs", 1, 1.2);
    EXPECT_EQ(verdict("C05", wide(samples)), VerdictKind::reproduced_only_for);
    samples[0] = sample("pbs", 0, 1.2);
    EXPECT_EQ(verdict("C05", wide(samples)), VerdictKind::not_reproduced);
}

// Only pbs itself assigns the limb to another part.
TEST_F(ArtefactsVerdict, HoweverWideASectionOfPbsAloneItFails)
{
    for (const double wide_over_rest : {2.9, 3.1, 8.0})
        EXPECT_EQ(verdict("C05", wide({sample("pbs", 0, wide_over_rest), sample("reference", 0, 1.0, 1)})), VerdictKind::not_reproduced)
            << wide_over_rest;
}

// The value of the body exceeds it, and its interval also covers linear elements.
TEST_F(ArtefactsVerdict, QuadraticElementsAreTheReference)
{
    std::vector<ArtefactSample> samples = {sample("pbs", 0, 1.0), sample("reference", 0, 1.0, 1)};
    EXPECT_EQ(verdict("C05", wide(samples)), VerdictKind::reproduced);
    samples.push_back(sample("reference", 0, 0.8, 2));
    EXPECT_EQ(verdict("C05", wide(samples)), VerdictKind::not_reproduced);
    EXPECT_DOUBLE_EQ(wide(samples)[0].value, 1.25);
}

TEST_F(ArtefactsVerdict, WithoutAReferenceThereIsNoVerdict)
{
    EXPECT_EQ(verdict("C05", wide({sample("pbs", 0, 1.0)})), VerdictKind::not_computable);
    EXPECT_EQ(verdict("C04", thin({sample("lbs", 0, 0.1)})), VerdictKind::not_computable);
}

TEST_F(ArtefactsVerdict, ARatioAboveOneIsNotSmoother)
{
    bent.poses = {{2, "bend_60_deg"}};
    std::vector<Measurement> measured = experiments::compare_weights(bent).measurements;
    expect_the_claims_quantities("C06", measured);
    const auto put = [&](const std::string& quantity, const analysis::CaseKey& of, double ratio) {
        for (Measurement& measurement : measured)
            if (measurement.quantity == quantity && analysis::matches(measurement.of, of))
                measurement.value = measurement.low = measurement.high = ratio;
    };
    put("strain_jump_over_rigid_weights", {}, 0.5);
    put("curvature_over_rigid_weights", {}, 9.0);  // reported only
    EXPECT_EQ(verdict("C06", measured), VerdictKind::reproduced);
    put("strain_jump_over_rigid_weights", {.deformer = "pbs"}, 1.1);
    EXPECT_EQ(verdict("C06", measured), VerdictKind::not_reproduced);
}

}  // namespace
