// Reference: a page of a few references and pairs by hand.
#include "experiments/studies/ensemble/ensemble_page.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

MemberRow member_of(const std::string& pose, const std::string& name, const std::string& outcome, std::optional<double> bound_pct)
{
    MemberRow row;
    row.of = {.body = "human", .motion = "01_01", .pose = pose};
    row.member.name = name;
    row.outcome = outcome;
    row.error_bound_pct = bound_pct;
    row.worst_tet = 1234;
    row.j_min = -0.5;
    row.inverted_tets = 3;
    row.solve_s = 90.0;
    return row;
}

PairRow pair_of(const std::string& first, const std::string& second, double difference_pct, analysis::PairDecision decision)
{
    PairRow row;
    row.of = {.body = "human", .motion = "01_01", .pose = "crouch"};
    row.first = first;
    row.second = second;
    row.largest_difference_pct = difference_pct;
    row.decision = decision;
    return row;
}

TEST(EnsemblePage, ListsTheReferencesThatDecideNothingWithTheirWorstTet)
{
    const std::string page =
        ensemble_page({}, {member_of("crouch", "smooth", "reached", 0.1), member_of("crouch", "nu_0.49", "reached", {}),
                           member_of("landing", "smooth", "not_converged", {})});
    EXPECT_NE(page.find("2 of 3 references were reached. 1 of these"), std::string::npos) << page;
    EXPECT_NE(page.find("| human | 01_01 | crouch |  | nu_0.49 | reached | 1234 | -0.500 | 3 | - |"), std::string::npos) << page;
    EXPECT_NE(page.find("| human | 01_01 | landing |  | smooth | not_converged | 1234 | -0.500 | 3 | - |"), std::string::npos) << page;
    EXPECT_EQ(page.find("crouch |  | smooth"), std::string::npos) << "that one decides";
}

TEST(EnsemblePage, WithoutSuchReferencesHasNoList)
{
    EXPECT_EQ(ensemble_page({}, {member_of("crouch", "smooth", "reached", 0.1)}).find("no bound on their own error\n\nThe worst"),
              std::string::npos);
}

TEST(EnsemblePage, SumsTheTimesOfAPose)
{
    const std::string page =
        ensemble_page({}, {member_of("crouch", "smooth", "reached", 0.1), member_of("crouch", "nu_0.3", "reached", 0.1),
                           member_of("landing", "smooth", "reached", 0.1)});
    EXPECT_NE(page.find("| human | 01_01 | crouch | 3.0 |"), std::string::npos) << page;
    EXPECT_NE(page.find("| human | 01_01 | landing | 1.5 |"), std::string::npos) << page;
}

TEST(EnsemblePage, CountsThePairsThatDifferNotably)
{
    using analysis::PairDecision;
    const std::string page =
        ensemble_page({pair_of("lbs", "pbs", 3.0, PairDecision::decided), pair_of("dqs", "pbs", 2.5, PairDecision::models_disagree),
                       pair_of("lbs", "fem_linear", 9.0, PairDecision::decided), pair_of("lbs", "dqs", 1.0, PairDecision::decided)},
                      {});
    EXPECT_NE(page.find("2 of 3 pairs of deformers"), std::string::npos) << page;
    EXPECT_NE(page.find("these are 1 of 2 pairs"), std::string::npos) << page;
    EXPECT_NE(page.find("| human | 01_01 | crouch |  | dqs | pbs | 2.5 |"), std::string::npos) << page;
}

}  // namespace
