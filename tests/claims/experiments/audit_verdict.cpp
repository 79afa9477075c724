// C13, C14 and C15 are judged from the paper's printed values, and C16 from none: if the printed values are corrected, the verdicts change.
// Reference: Euler's formula, sums and quotients of Table 1, derivatives of Eq. 11.
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::VerdictKind;
using test_support::claim;

const analysis::Records& print()
{
    static const analysis::Records records = test_support::records_of(experiments::audit_study().plan(false));
    return records;
}

TEST(AuditVerdict, ThePaperContradictsItself)
{
    for (const char* id : {"C13", "C14", "C15"}) EXPECT_EQ(judge(claim(id), print()).kind, VerdictKind::inconsistent_in_print) << id;
}

TEST(AuditVerdict, APrintThatIsMendedIsConsistent)
{
    analysis::Records mended = print();
    for (auto& value : mended.printed) value.printed = value.least;
    for (const char* id : {"C13", "C14", "C15"}) {
        EXPECT_EQ(judge(claim(id), mended).kind, VerdictKind::reproduced) << id;
        analysis::Records one_wrong = mended;
        const auto first = std::find_if(one_wrong.printed.begin(), one_wrong.printed.end(), [&](auto& value) { return value.claim == id; });
        first->printed = first->least - 1.0;
        EXPECT_EQ(judge(claim(id), one_wrong).kind, VerdictKind::inconsistent_in_print) << id;
    }
    EXPECT_EQ(judge(claim("C13"), {}).kind, VerdictKind::not_computable);
}

TEST(AuditVerdict, WhatCannotBeTestedSaysWhy)
{
    const analysis::Verdict verdict = judge(claim("C16"), {});
    EXPECT_EQ(verdict.kind, VerdictKind::cannot_be_tested_here);
    EXPECT_NE(verdict.claim.reason.find("no figure"), std::string::npos) << verdict.claim.reason;
}

}  // namespace
