// References: the studies convergence and ensemble, which measure the same 24 iterations, convergence with another solver; and the
// definitions of the parts, which are distances and fulfil the triangle inequality.
#include "experiments/studies/ensemble/ensemble.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/convergence/convergence_records.hpp"
#include "experiments/studies/shared/posed_reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;

ErrorSplitCase small_limb(const std::string& scene, int frame)
{
    ErrorSplitCase of;
    of.scene = read_scene(scene, {"character.vertices=300"});
    of.frames = {frame};
    of.pbs = spec_of(of.scene, "pbs");
    of.reference = reference_flesh(of.scene);
    of.k_stretch = {0.2};
    of.iterations = {24};
    of.converged_iterations = 400;
    return of;
}

// Of the row from LBS, with PBS in double as in error_split.
RateRow row_of_convergence(const ErrorSplitCase& as)
{
    ConvergenceCase of;
    of.scene = as.scene;
    of.frames = {{as.frames.front(), "pose", {}, false, true}};
    of.k_stretch = as.k_stretch;
    of.settings = {{options_of<pbs::PbsOptions>(as.pbs).order, pbs::Precision::f64}};
    of.most_iterations = 24;
    of.reference = as.reference;
    return rate_rows(measure_convergence(of)).front();
}

// PBS in double against the one reference of error_split.
ErrorRow row_of_ensemble(const ErrorSplitCase& as)
{
    EnsembleCase of;
    of.scene = as.scene;
    of.frame = as.frames.front();
    of.flesh = as.reference;
    of.members = {{.name = "reference"}};
    of.deformers = {as.pbs};
    options_of<pbs::PbsOptions>(of.deformers.front()).precision = pbs::Precision::f64;
    return measure_ensemble(of).errors.front();
}

void expect_same_error_in_all_studies(const ErrorSplitCase& of, const ErrorParts& parts)
{
    const ErrorRow other = row_of_ensemble(of);
    const double rounding = 1e-12 * parts.whole_joint_pct;  // sums over the vertices, in another order
    EXPECT_NEAR(other.error_joint_pct, parts.error_joint_pct, rounding);
    EXPECT_NEAR(other.whole_joint_pct, parts.whole_joint_pct, rounding);
    const RateRow row = row_of_convergence(of);
    EXPECT_GT(parts.error_joint_pct, 0.0);
    EXPECT_NEAR(row.paper.error_joint_pct, parts.error_joint_pct, rounding);
    EXPECT_NEAR(row.paper.whole_joint_pct, parts.whole_joint_pct, rounding);
    EXPECT_EQ(row.quality.masked_share_pct, parts.masked_share_pct);
    EXPECT_EQ(row.quality.observed_order, parts.observed_order);
    EXPECT_EQ(row.quality.bound_pct, parts.discretisation_pct);
}

ErrorParts only_parts(const ErrorSplitCase& of)
{
    const ErrorSplit split = split_error(of);
    EXPECT_EQ(split.breakdown, "");
    EXPECT_EQ(split.parts.size(), 1u);
    return split.parts.at(0);
}

TEST(ErrorSplit, HasTheSameErrorAsConvergenceAndEnsemble)
{
    const ErrorSplitCase twist = small_limb("limb_twist", 18);  // 90 degrees
    const ErrorParts parts = only_parts(twist);
    expect_same_error_in_all_studies(twist, parts);
    EXPECT_EQ(parts.masked_share_pct, 0.0);
    EXPECT_EQ(parts.error_joint_pct, parts.whole_joint_pct);
}

// Where the limb overlaps itself, the error outside the mask is not that of the whole body.
TEST(ErrorSplit, LeavesOutTheOverlapAsTheyDo)
{
    const ErrorSplitCase fold = small_limb("limb_bend", 24);  // 120 degrees
    const ErrorParts parts = only_parts(fold);
    expect_same_error_in_all_studies(fold, parts);
    EXPECT_GT(parts.masked_share_pct, 0.0);
    EXPECT_LT(parts.masked_share_pct, 100.0);
    EXPECT_NE(parts.error_joint_pct, parts.whole_joint_pct);
}

TEST(ErrorSplit, MeasuresEachAttachmentAgainstTheReference)
{
    ErrorSplitCase of = small_limb("limb_twist", 6);  // 30 degrees
    of.others = other_attachments(of.reference);
    const ErrorSplit split = split_error(of);
    const ErrorParts& parts = split.parts.at(0);
    EXPECT_LE(parts.error_joint_pct, parts.solver_pct + parts.model_pct);
    EXPECT_LE(parts.model_pct, parts.error_joint_pct + parts.solver_pct);
    ASSERT_EQ(split.attachments.size(), 1 + of.others.size());
    const AttachmentShare& own = split.attachments.front();
    EXPECT_EQ(own.reference, "neo_hookean");
    EXPECT_EQ(own.difference_pct, 0.0);
    EXPECT_EQ(own.model_pct, parts.model_pct);
    EXPECT_EQ(own.spring_factor, 10.0);
    for (std::size_t i = 1; i < split.attachments.size(); ++i) {
        const AttachmentShare& other = split.attachments[i];
        EXPECT_EQ(other.reference, of.others[i - 1].label);
        EXPECT_TRUE(other.finished) << other.reference;
        EXPECT_GT(other.difference_pct, 0.0) << other.reference;
        EXPECT_LE(other.model_pct, own.model_pct + other.difference_pct) << other.reference;
        EXPECT_EQ(other.core_radius.has_value(), other.attachment != "bind");
    }
    const auto factor_of = [&](const char* label) {
        return std::ranges::find(split.attachments, label, &AttachmentShare::reference)->spring_factor;
    };
    EXPECT_EQ(factor_of("smooth_q_100"), 100.0);
    EXPECT_EQ(factor_of("embedded"), 1e4);
    EXPECT_EQ(factor_of("bind"), 1e4);  // its stiffness is q E V / R^2 (bone_attachment.hpp)
    const auto difference_pct = [&](const char* label) {
        return std::ranges::find(split.attachments, label, &AttachmentShare::reference)->difference_pct;
    };
    EXPECT_GT(difference_pct("linear_smooth"), difference_pct("smooth_q_100"));  // small strain at 30 degrees
}

TEST(ErrorSplit, WithoutAReferenceHasNoRowsAndNamesTheWorstTet)
{
    ErrorSplitCase of = small_limb("limb_twist", 18);
    options_of<FemOptions>(of.reference).most_newton_steps = 1;
    const ErrorSplit split = split_error(of);
    EXPECT_TRUE(split.parts.empty());
    EXPECT_TRUE(split.attachments.empty());
    EXPECT_TRUE(split.breakdown.starts_with("neo_hookean in frame 18: not reached, worst tet ")) << split.breakdown;
    EXPECT_NE(split.breakdown.find(" of volume ratio "), std::string::npos) << split.breakdown;
}

}  // namespace
