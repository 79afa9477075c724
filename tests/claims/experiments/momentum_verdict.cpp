// C07 is judged from the momentum study's own values: if they are altered, the verdict changes. Reference: Newton's third law; projections
// with the masses of the momentum conserve it, and Eq. 8-9 for m = 1 on unequal masses do not.
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::VerdictKind;
using test_support::claim;

const analysis::Records& limb()
{
    static const analysis::Records records = test_support::records_of(experiments::momentum_study().plan(false));
    return records;
}

TEST(MomentumVerdict, HoldsWhereMassesAreKnownAndNotByEquationsForOneMass)
{
    const analysis::Verdict verdict = judge(claim("C07"), limb());
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(verdict.subjects.size(), 3u);
    EXPECT_EQ(verdict.subjects[2].name, "unequal_by_eq_8_9");
    for (const auto& subject : verdict.subjects) EXPECT_EQ(subject.extent == analysis::Extent::none, subject.name == "unequal_by_eq_8_9");
}

TEST(MomentumVerdict, TurnsWithItsFigures)
{
    analysis::Records records = limb();
    for (auto& measured : records.measurements) measured.value = measured.low = measured.high = 1e-9;
    EXPECT_EQ(judge(claim("C07"), records).kind, VerdictKind::reproduced);
    for (auto& measured : records.measurements) measured.value = measured.low = measured.high = 0.1;
    EXPECT_EQ(judge(claim("C07"), records).kind, VerdictKind::not_reproduced);
}

}  // namespace
