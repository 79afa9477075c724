// Reference: the study convergence, which measures the same 24 iterations of PBS with another solver, the finite
// elements on each mesh by themselves, and the definitions of the parts.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "tests/support/long_form.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace {

using namespace experiments;

EnsembleCase split_limb(const std::string& scene, int frame)
{
    EnsembleCase of;
    of.scene = read_scene(scene, {"character.vertices=300"});
    of.frame = frame;
    of.flesh = reference_flesh(of.scene);
    of.effort = ReferenceEffort::refined;
    of.pbs = spec_of(of.scene, "pbs");
    of.k_stretch = {0.2};
    of.iterations = {24};
    of.converged_iterations = 400;
    return of;
}

// The tests of a suite keep their solved references in this folder, so that each is solved once.
std::string solutions()
{
    static const test_support::ScratchFolder folder;
    return folder.path().string();
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
    return rate_rows(measure_convergence(of, solutions())).front();
}

// The parts, after a check that convergence, which has another solver, measures the same errors after these iterations.
// Both read the same solved reference.
PartsRow checked_parts(const EnsembleCase& of)
{
    const EnsembleRecords records = measure_ensemble(of, solutions());
    EXPECT_EQ(records.parts.size(), 1u);
    const PartsRow& parts = records.parts.at(0);
    const double rounding = 1e-12 * parts.whole_joint_pct;  // sums over the vertices, in another order
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
    const bool is_long = test_support::is_long_form();                                   // large angles take longer
    const PartsRow twisted = checked_parts(split_limb("limb_twist", is_long ? 18 : 6));  // 90 or 30 deg
    const PartsRow bent = checked_parts(split_limb("limb_bend", is_long ? 24 : 16));     // 120 or 80 deg
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
    const EnsembleRecords records = measure_ensemble(of, solutions());
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
    const auto row_of = [&](const char* label) {
        return *std::ranges::find(records.attachments, label, &AttachmentRow::reference);
    };
    EXPECT_EQ(row_of("smooth_q_100").spring_factor, 100.0);
    EXPECT_EQ(row_of("embedded").spring_factor, 1e4);
    EXPECT_EQ(row_of("bind").spring_factor, 1e4);  // its stiffness is q E V / R^2 (bone_attachment.hpp)
    // small strain at 30 degrees
    EXPECT_GT(row_of("linear_smooth").difference_pct, row_of("smooth_q_100").difference_pct);
}

// Linear and quadratic elements on the character's own tets, each solved alone.
TEST(OwnTets, HaveTheDistanceOfLinearElementsAndABoundThatCoversFinerTets)
{
    EnsembleCase of = split_limb("limb_twist", 12);  // 60 degrees
    of.k_stretch = {};
    const EnsembleRecords records = measure_ensemble(of);
    EXPECT_TRUE(records.parts.empty());
    EXPECT_TRUE(records.attachments.empty());
    ASSERT_EQ(records.own_tets.size(), 1u);
    const OwnTetsRow& row = records.own_tets.front();
    const PosedCharacter limb(of.scene, {of.frame});
    const auto solved = [&](int element_order) {
        DeformerSpec flesh = of.flesh;
        options_of<FemOptions>(flesh).element_order = element_order;
        options_of<FemOptions>(flesh).nested_start = element_order == 2;
        return limb.shapes(flesh).front();
    };
    const double linear_distance_pct = limb.distance(solved(1), solved(2)).joint_pct;
    EXPECT_NEAR(row.linear_distance_pct.value(), linear_distance_pct, 1e-6 * linear_distance_pct)
        << "Newton's method leaves less";
    const PosedReference reference(limb.character(), of.flesh, limb.pose(0), of.scene.motion.time_step_s,
                                   ReferenceEffort::refined);
    EXPECT_GT(row.bound_pct.value(), reference.error_of(solved(2).positions).joint_pct);
    EXPECT_LT(row.bound_pct.value(), linear_distance_pct);
}

TEST(Ensemble, WithAReferenceThatIsNotReachedHasNoRows)
{
    EnsembleCase of = split_limb("limb_twist", 18);
    options_of<FemOptions>(of.flesh).most_newton_steps = 1;
    const EnsembleRecords records = measure_ensemble(of);
    EXPECT_TRUE(records.own_tets.empty());
    EXPECT_TRUE(records.parts.empty());
    EXPECT_TRUE(records.attachments.empty());
}

}  // namespace
