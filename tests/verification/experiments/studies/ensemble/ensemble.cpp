// Reference: the candy wrapper. Linear blending loses more volume in a twist than dual quaternions do, whose sections stay whole, so that
// every member of the family finds dual quaternions closer.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "experiments/deformers/registry.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

EnsembleCase twisted_limb()
{
    EnsembleCase of;
    of.of = {.body = "limb", .motion = "twist", .angle_deg = 90.0};
    of.scene = read_scene("limb_twist", {"motion.angle_deg=90", "motion.frames=2", "character.vertices=300"});
    of.frame = 1;
    of.flesh = default_spec("fem");
    options_of<FemOptions>(of.flesh).model = reference_fem::Model::neo_hookean;
    of.members = {family().front(), family().back()};
    of.deformers = {default_spec("lbs"), default_spec("dqs")};
    return of;
}

TEST(Ensemble, OrdersDeformersThatAllReferencesOrder)
{
    const EnsembleRecords records = measure_ensemble(twisted_limb());
    EXPECT_EQ(records.breakdown, "");
    ASSERT_EQ(records.members.size(), 2u);
    for (const MemberRow& row : records.members) {
        EXPECT_EQ(row.outcome, "reached");
        EXPECT_EQ(row.element_order, 2);
        EXPECT_EQ(row.refinements, 1);
        ASSERT_TRUE(row.error_bound_pct);
        EXPECT_GT(*row.error_bound_pct, 0.0);
    }
    ASSERT_EQ(records.errors.size(), 4u);
    const auto error_pct = [&](std::size_t member, std::size_t deformer) { return records.errors[2 * member + deformer].error_joint_pct; };
    ASSERT_EQ(records.pairs.size(), 1u);
    const PairRow& pair = records.pairs.front();
    EXPECT_EQ(pair.first, "lbs");
    EXPECT_EQ(pair.second, "dqs");
    EXPECT_EQ(pair.difference_pct, error_pct(0, 1) - error_pct(0, 0));
    EXPECT_LT(*pair.difference_pct, 0.0);
    EXPECT_EQ(pair.second_is_closer, 2);
    EXPECT_EQ(pair.decision, analysis::PairDecision::decided);
}

// A reference that is not reached decides nothing.
TEST(Ensemble, WithAReferenceThatIsNotReachedIsUndecided)
{
    EnsembleCase of = twisted_limb();
    options_of<FemOptions>(of.flesh).most_newton_steps = 1;
    const EnsembleRecords records = measure_ensemble(of);
    for (const MemberRow& row : records.members) EXPECT_EQ(row.outcome, "not_converged");
    EXPECT_TRUE(records.errors.empty());
    ASSERT_EQ(records.pairs.size(), 1u);
    EXPECT_FALSE(records.pairs.front().difference_pct);
    EXPECT_EQ(records.pairs.front().decision, analysis::PairDecision::reference_error);
}

}  // namespace
