// Reference: the candy wrapper. Linear blending loses more volume in a twist than dual quaternions do, whose sections stay whole, so that
// every member of the family finds dual quaternions closer. The parts of PBS's error: the study convergence, which measures the same 24
// iterations with another solver, and the definitions of the parts.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
    const test_support::ScratchFolder solutions;
    const EnsembleRecords records = measure_ensemble(twisted_limb(), solutions.path());
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
    // The same from the table as it is written, by the rule itself: |e_A^2 - e_B^2| > 2 |A - B| U.
    const auto table = analysis::parse_csv(table_of(pair_order_columns, records.orders).text(), "pair_orders.csv");
    ASSERT_EQ(table.rows(), 2);
    for (int row = 0; row < 2; ++row) {
        const double lbs = table.number(row, "first_error_pct"), dqs = table.number(row, "second_error_pct");
        EXPECT_GT(lbs * lbs - dqs * dqs, 2.0 * table.number(row, "distance_pct") * table.number(row, "error_bound_pct"));
        EXPECT_EQ(table.text_at(row, "order"), "second_is_closer");
        EXPECT_EQ(table.number(row, "error_bound_pct"), *records.members[row].error_bound_pct);
    }
    // With other settings DQS is LBS, so that the pair is not decided, although all references decide it with the default settings.
    EnsembleCase tuned = twisted_limb();
    tuned.tuned = {default_spec("lbs")};
    tuned.tuned.front().label = "dqs";
    const EnsembleRecords both = measure_ensemble(tuned, solutions.path());
    EXPECT_EQ(both.pairs.front().decision, analysis::PairDecision::reference_error);
    EXPECT_EQ(both.pairs.front().second_is_closer, 2);
    ASSERT_EQ(both.orders.size(), 4u);
    for (const PairOrderRow& row : both.orders) EXPECT_EQ(row.distance_pct == 0.0, row.settings == SettingsOf::training_poses);
}

// A reference that is not reached decides nothing, and its row names the worst tet.
TEST(Ensemble, WithAReferenceThatIsNotReachedIsUndecidedAndHasNoParts)
{
    EnsembleCase of = twisted_limb();
    options_of<FemOptions>(of.flesh).most_newton_steps = 1;
    of.pbs = spec_of(of.scene, "pbs");
    of.k_stretch = {0.2};
    of.iterations = {24};
    const EnsembleRecords records = measure_ensemble(of);
    for (const MemberRow& row : records.members) {
        EXPECT_EQ(row.outcome, "not_converged");
        EXPECT_GE(row.worst_tet, 0);
        EXPECT_LT(row.j_min, 1.0);
    }
    EXPECT_TRUE(records.errors.empty());
    EXPECT_TRUE(records.parts.empty());
    EXPECT_TRUE(records.attachments.empty());
    ASSERT_EQ(records.pairs.size(), 1u);
    EXPECT_FALSE(records.pairs.front().difference_pct);
    for (const PairOrderRow& row : records.orders) EXPECT_FALSE(row.distance_pct || row.order != analysis::PairOrder::undecided);
    EXPECT_EQ(records.pairs.front().decision, analysis::PairDecision::reference_error);
}

EnsembleCase split_limb(const std::string& scene, int frame)
{
    EnsembleCase of;
    of.scene = read_scene(scene, {"character.vertices=300"});
    of.frame = frame;
    of.flesh = reference_flesh(of.scene);
    of.members = {family().front()};
    of.effort = ReferenceEffort::refined;
    of.pbs = spec_of(of.scene, "pbs");
    of.deformers = {of.pbs};
    options_of<pbs::PbsOptions>(of.deformers.front()).precision = pbs::Precision::f64;  // as the parts are measured
    of.k_stretch = {0.2};
    of.iterations = {24};
    of.converged_iterations = 400;
    return of;
}

// The row from LBS, with PBS in double.
RateRow row_of_convergence(const EnsembleCase& as)
{
    ConvergenceCase of;
    of.scene = as.scene;
    of.frames = {{as.frame, "pose", {}, false, true}};
    of.k_stretch = as.k_stretch;
    of.settings = {{options_of<pbs::PbsOptions>(as.pbs).order, pbs::Precision::f64}};
    of.most_iterations = 24;
    of.reference = as.flesh;
    of.effort = as.effort;
    return rate_rows(measure_convergence(of)).front();
}

// The parts, after a check that the errors of the same 24 iterations and convergence, which has another solver, are the same.
PartsRow checked_parts(const EnsembleCase& of)
{
    const EnsembleRecords records = measure_ensemble(of);
    EXPECT_EQ(records.breakdown, "");
    EXPECT_EQ(records.parts.size(), 1u);
    const PartsRow& parts = records.parts.at(0);
    const double rounding = 1e-12 * parts.whole_joint_pct;  // sums over the vertices, in another order
    EXPECT_NEAR(records.errors.front().error_joint_pct, parts.error_joint_pct, rounding);
    EXPECT_NEAR(records.errors.front().whole_joint_pct, parts.whole_joint_pct, rounding);
    const RateRow row = row_of_convergence(of);
    EXPECT_GT(parts.error_joint_pct, 0.0);
    EXPECT_NEAR(row.paper.error_joint_pct, parts.error_joint_pct, rounding);
    EXPECT_NEAR(row.paper.whole_joint_pct, parts.whole_joint_pct, rounding);
    EXPECT_EQ(row.quality.masked_share_pct, parts.masked_share_pct);
    EXPECT_EQ(row.quality.bound_pct, parts.discretisation_pct);
    return parts;
}

// Where the limb is creased, the error outside the mask is not that of the whole body.
TEST(ErrorSplit, HasTheSameErrorAsConvergenceAndLeavesOutTheTipOfACrease)
{
    const PartsRow twisted = checked_parts(split_limb("limb_twist", 18)), bent = checked_parts(split_limb("limb_bend", 24));  // 90, 120 deg
    EXPECT_EQ(twisted.masked_share_pct, 0.0);
    EXPECT_EQ(twisted.error_joint_pct, twisted.whole_joint_pct);
    EXPECT_GT(bent.masked_share_pct, 0.0);
    EXPECT_LT(bent.masked_share_pct, 100.0);
    EXPECT_NE(bent.error_joint_pct, bent.whole_joint_pct);
}

// The parts are distances and fulfil the triangle inequality.
TEST(ErrorSplit, MeasuresEachAttachmentAgainstTheReference)
{
    EnsembleCase of = split_limb("limb_twist", 6);  // 30 degrees
    of.other_flesh = other_attachments(of.flesh);
    const EnsembleRecords records = measure_ensemble(of);
    const PartsRow& parts = records.parts.at(0);
    EXPECT_LE(parts.error_joint_pct, parts.solver_pct + parts.model_pct);
    EXPECT_LE(parts.model_pct, parts.error_joint_pct + parts.solver_pct);
    ASSERT_EQ(records.attachments.size(), 1 + of.other_flesh.size());
    const AttachmentRow& own = records.attachments.front();
    EXPECT_EQ(own.reference, "neo_hookean");
    EXPECT_EQ(own.difference_pct, 0.0);
    EXPECT_EQ(own.model_pct, parts.model_pct);
    EXPECT_EQ(own.spring_factor, 10.0);
    for (std::size_t i = 1; i < records.attachments.size(); ++i) {
        const AttachmentRow& other = records.attachments[i];
        EXPECT_EQ(other.reference, of.other_flesh[i - 1].label);
        EXPECT_TRUE(other.finished) << other.reference;
        EXPECT_GT(other.difference_pct, 0.0) << other.reference;
        EXPECT_LE(other.model_pct, own.model_pct + other.difference_pct) << other.reference;
        EXPECT_EQ(other.core_radius.has_value(), other.attachment != "bind");
    }
    const auto row_of = [&](const char* label) { return *std::ranges::find(records.attachments, label, &AttachmentRow::reference); };
    EXPECT_EQ(row_of("smooth_q_100").spring_factor, 100.0);
    EXPECT_EQ(row_of("embedded").spring_factor, 1e4);
    EXPECT_EQ(row_of("bind").spring_factor, 1e4);  // its stiffness is q E V / R^2 (bone_attachment.hpp)
    EXPECT_GT(row_of("linear_smooth").difference_pct, row_of("smooth_q_100").difference_pct);  // small strain at 30 degrees
}

}  // namespace
