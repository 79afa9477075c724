// The deformer's reports, and the inputs that it refuses. The verification tests show that it deforms correctly.
#include "experiments/deformers/fem/fem_deformers.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/newton_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/solve_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

const FemOptions linear_tets{.element_order = 1};

pbs::Pose bent(const pbs::Character& character, double angle_deg)
{
    return pbs::joint_sweep(character.skeleton, 1, pbs::Vec3::UnitZ(), angle_deg, 2, 0.01).steps.back();
}

TEST(LinearFemDeformer, BarHasTheConditionNumberThatOthersRelyOn)
{
    const auto character = test_support::bar_character({12, 3, 3});
    const FemOptions options{.element_order = 2};
    const auto spectrum = test_support::spectrum_of(character.mesh,
                                                    {.element_order = options.element_order,
                                                     .young_pa = options.young_pa,
                                                     .poisson = options.poisson,
                                                     .density_kg_m3 = options.density_kg_m3,
                                                     .formulation = options.formulation},
                                                    bone_attachment(character, options).attachment);
    EXPECT_LT(spectrum.condition(), test_support::quadratic_bar_condition);
}

TEST(LinearFemDeformer, RecordsWhatIsGrippedOfEachBone)
{
    const auto character = test_support::bar_character({24, 4, 4});
    LinearFemDeformer fem(linear_tets);
    EXPECT_TRUE(fem.record().is_null());
    fem.reset(character);
    fem.advance(bent(character, 10.0), 0.01);
    fem.advance(bent(character, 5.0), 0.01);
    const nlohmann::json record = fem.record();
    EXPECT_EQ(record["frames"], 2);
    // The angle is that of a quaternion of norm one, some twenty roundings after the angle of the pose.
    const double degree = std::acos(-1.0) / 180.0, rounding = test_support::rounding_error(20, 1.0);
    EXPECT_NEAR(record["largest_rotation_deg"].get<double>(), 10.0, rounding / degree);
    EXPECT_NEAR(record["fictitious_strain"].get<double>(), 1.0 - std::cos(10.0 * degree), rounding);
    // |r| <= sqrt(n) eps |K| |u| (reference_fem/verification/problems.hpp). The stiffest entries of K are those of the springs, which
    // are also the load, so that |K| |u| is at most 100 |f|.
    const double unknowns = 3.0 * static_cast<double>(character.mesh.rest.rows());
    EXPECT_LT(record["largest_residual"].get<double>(), test_support::rounding_error(2.0 * std::sqrt(unknowns), 100.0));
    EXPECT_EQ(record["setup"]["dofs"], 3 * character.mesh.rest.rows());
    ASSERT_EQ(record["attachment"]["bones"].size(), 2u);
    for (const auto& bone : record["attachment"]["bones"]) {
        EXPECT_EQ(bone["samples"], 7720);
        EXPECT_EQ(bone["inside"], 7720);
        EXPECT_GT(bone["tets_gripped"].get<int>(), 0);
        EXPECT_GE(bone["skin_share"].get<double>(), 0.0);
        EXPECT_LT(bone["skin_share"].get<double>(), 1.0);
        EXPECT_EQ(bone["shared_vertices"], 0);
        EXPECT_GT(bone["grip_error_rms_m"].get<double>(), 0.0);
        EXPECT_LE(bone["grip_error_rms_m"].get<double>(), record["largest_grip_error_m"].get<double>());
    }
}

TEST(LinearFemDeformer, OnlyNodesArePrescribedVertices)
{
    const auto character = test_support::bar_character({48, 8, 8});
    LinearFemDeformer embedded(linear_tets);
    embedded.reset(character);
    EXPECT_TRUE(embedded.prescribed().empty());
    LinearFemDeformer nodes({.element_order = 1, .attachment = FemAttachment::nodes, .core_radius = 0.6});
    nodes.reset(character);
    const std::vector<bool> prescribed = nodes.prescribed();
    ASSERT_EQ(static_cast<Eigen::Index>(prescribed.size()), character.mesh.rest.rows());
    const pbs::Pose pose = bent(character, 10.0);
    nodes.advance(pose, 0.01);
    const BoneAttachment bones = nodes_attachment(character, {.core_radius = 0.6});
    const double rounding_m = test_support::frame_rounding_m(nodes.positions());
    for (Eigen::Index v = 0; v < character.mesh.rest.rows(); ++v) {
        EXPECT_EQ(prescribed[v], bones.vertex_bone[v] >= 0);
        if (!prescribed[v]) continue;
        const pbs::Vec3 target = pose[bones.vertex_bone[v]] * pbs::Vec3(character.mesh.rest.row(v).transpose());
        EXPECT_LT((nodes.positions().row(v).transpose() - target).norm(), rounding_m);
    }
}

TEST(LinearFemDeformer, ABoneOutsideTheFleshIsRefusedByName)
{
    auto character = test_support::bar_character({24, 4, 4});
    character.skeleton.bones.push_back({"ghost", 0, {0, 5, 0}, {0, 6, 0}});
    LinearFemDeformer fem(linear_tets);
    try {
        fem.reset(character);
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("ghost"), std::string::npos) << error.what();
    }
}

TEST(LinearFemDeformer, APoseThatIsNotANumberIsAReportedOutcome)
{
    const auto character = test_support::bar_character({24, 4, 4});
    LinearFemDeformer fem(linear_tets);
    fem.reset(character);
    pbs::Pose broken = bent(character, 10.0);
    broken[1].translation()(0) = std::nan("");
    EXPECT_EQ(fem.advance(broken, 0.01).outcome, pbs::Outcome::not_finite);
    EXPECT_EQ(fem.advance(bent(character, 10.0), 0.01).outcome, pbs::Outcome::finished);
    EXPECT_EQ(fem.record()["frames_not_finite"], 1);
}

TEST(LinearFemDeformer, ResetStartsTheRecordAnew)
{
    const auto character = test_support::bar_character({24, 4, 4});
    LinearFemDeformer fem(linear_tets);
    fem.reset(character);
    fem.advance(bent(character, 10.0), 0.01);
    fem.reset(character);
    EXPECT_EQ(fem.record()["frames"], 0);
    EXPECT_EQ(fem.positions(), character.mesh.rest);
}

}  // namespace
