// How the deformer reaches frames, and what it reports of those that it does not reach. The verification tests show that it deforms
// correctly. Tolerances between two solutions for one pose: newton_error_m, the error that Newton's method leaves, for each of them.
#include "experiments/deformers/fem/fem_deformers.hpp"

#include "pbs/character/character.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/newton_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using reference_fem::Dynamics;
using reference_fem::Model;

const FemOptions coarse{.model = Model::stable_neo_hookean, .element_order = 1};

const pbs::Character& bar()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

pbs::Pose bent(double angle_deg)
{
    return pbs::joint_sweep(bar().skeleton, 1, pbs::Vec3::UnitZ(), angle_deg, 2, 0.01).steps.back();
}

pbs::Pose not_a_number()
{
    pbs::Pose broken = bent(10.0);
    broken[1].translation()(0) = std::nan("");
    return broken;
}

// The forearm is pushed 0.7 m into the upper arm: the flesh between the facing ends of the capsules, 1/3 m long, would have to invert,
// which a law that is infinite at det F <= 0 prevents.
pbs::Pose crushed()
{
    pbs::Pose pose = bent(0.0);
    pose[1].translation()(0) = -0.7;
    return pose;
}

double largest_distance(const pbs::Positions& a, const pbs::Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

TEST(ElasticFemDeformer, RecordsModelGripAndNewton)
{
    ElasticFemDeformer fem(coarse);
    EXPECT_TRUE(fem.record().is_null());
    fem.reset(bar());
    fem.advance(bent(0.0), 0.01);
    EXPECT_EQ(fem.positions(), bar().mesh.rest);
    EXPECT_EQ(fem.advance(bent(20.0), 0.01).outcome, pbs::Outcome::finished);
    const nlohmann::json record = fem.record();
    EXPECT_EQ(record["model"], "stable_neo_hookean");
    EXPECT_EQ(record["formulation"], "displacement");
    EXPECT_EQ(record["dynamics"], "quasi_static");
    EXPECT_EQ(record["frames"], 2);
    EXPECT_FALSE(record.contains("fictitious_strain")) << "the law is objective";
    EXPECT_GT(record["newton"]["newton_steps"]["most"].get<int>(), 0);
    EXPECT_EQ(record["newton"]["frames_not_converged"], 0);
    EXPECT_GT(record["attachment"]["bones"][0]["grip_error_rms_m"].get<double>(), 0.0);
}

// Reference: an equilibrium does not depend on the path to it.
TEST(ElasticFemDeformer, ANestedStartLeadsToTheSameSolutionInFewerSteps)
{
    FemOptions options{.model = Model::stable_neo_hookean, .element_order = 2, .formulation = reference_fem::Formulation::mean_dilatation};
    ElasticFemDeformer along_the_way(options);
    options.nested_start = true;
    ElasticFemDeformer nested(options);
    for (ElasticFemDeformer* fem : {&along_the_way, &nested}) {
        fem->reset(bar());
        ASSERT_EQ(fem->advance(bent(75.0), 0.01).outcome, pbs::Outcome::finished);
    }
    const double error_m = test_support::newton_error_m(bar(), options, bent(75.0), nested.positions());
    EXPECT_LT(largest_distance(along_the_way.positions(), nested.positions()), 2.0 * error_m);
    EXPECT_LT(error_m, 1e-6) << "a bound that would let another shape of the bar of 2 m pass proves nothing";
    const auto steps = [](const ElasticFemDeformer& fem) { return fem.record()["newton"]["newton_steps"]["most"].get<int>(); };
    EXPECT_LT(steps(nested), steps(along_the_way));
}

// Reference: an equilibrium does not depend on the path to it.
TEST(ElasticFemDeformer, ARefinedCharactersNestedStartIsTheUnrefinedOnesSolution)
{
    const pbs::Character fine = pbs::refined(bar());
    FemOptions options = coarse;
    ElasticFemDeformer along_the_way(options);
    options.nested_start = true;
    ElasticFemDeformer nested(options);
    for (ElasticFemDeformer* fem : {&along_the_way, &nested}) {
        fem->reset(fine);
        ASSERT_EQ(fem->advance(bent(75.0), 0.01).outcome, pbs::Outcome::finished);
    }
    EXPECT_LT(largest_distance(along_the_way.positions(), nested.positions()),
              2.0 * test_support::newton_error_m(fine, options, bent(75.0), nested.positions()));
    const auto steps = [](const ElasticFemDeformer& fem) { return fem.record()["newton"]["newton_steps"]["most"].get<int>(); };
    EXPECT_LT(steps(nested), steps(along_the_way));
}

TEST(ElasticFemDeformer, WhereOrder1DoesNotArriveANestedStartGoesTheWayItself)
{
    FemOptions options{.model = Model::neo_hookean, .element_order = 2, .attachment = FemAttachment::embedded};  // crushes the flesh
    ElasticFemDeformer along_the_way(options);
    options.nested_start = true;
    ElasticFemDeformer nested(options);
    for (ElasticFemDeformer* fem : {&along_the_way, &nested}) {
        fem->reset(bar());
        EXPECT_EQ(fem->advance(crushed(), 0.01).outcome, pbs::Outcome::not_converged);
    }
    EXPECT_EQ(along_the_way.positions(), nested.positions());
}

// Order 1 may take four times the steps, which suffice for this pose. Reference: Newton's method alone from the same initial guess, which
// keeps its last iterate. The first step does not reduce the residual to a tenth, so that neither solve uses a factor again.
TEST(ElasticFemDeformer, AfterANestedStartThatFailsTheRecordIsOfTheLastNewtonState)
{
    FemOptions options{.model = Model::neo_hookean, .element_order = 2, .most_newton_steps = 2, .nested_start = true};
    ElasticFemDeformer nested(options);
    nested.reset(bar());
    ASSERT_EQ(nested.advance(bent(40.0), 0.01).outcome, pbs::Outcome::not_converged);
    ASSERT_EQ(nested.set_out_from().step.outcome, pbs::Outcome::finished);

    options.nested_start = false;
    ElasticFemDeformer alone(options);
    alone.reset(bar());
    alone.start_from(nested.set_out_from().deformer->positions());
    ASSERT_EQ(alone.advance(bent(40.0), 0.01).outcome, pbs::Outcome::not_converged);
    EXPECT_LT(largest_distance(nested.last_state(), alone.positions()), test_support::frame_rounding_m(alone.positions()));
    EXPECT_GT(largest_distance(nested.last_state(), nested.set_out_from().deformer->positions()), 1e-4);
    EXPECT_EQ(nested.positions(), bar().mesh.rest) << "the last equilibrium";
    const nlohmann::json failure = nested.record()["newton"]["not_converged"][0];
    EXPECT_NEAR(failure["lowest_det_f"].get<double>(), *alone.lowest_det_f(), 1e-12);
    EXPECT_LT(failure["lowest_det_f"].get<double>(), 0.999);
}

TEST(ElasticFemDeformer, WhereFewerNodesDoNotArriveTheirLastNewtonStateIsOnRecord)
{
    ElasticFemDeformer nested({.model = Model::neo_hookean, .element_order = 2, .most_newton_steps = 1, .nested_start = true});
    nested.reset(bar());
    ASSERT_EQ(nested.advance(bent(75.0), 0.01).outcome, pbs::Outcome::not_converged);
    const nlohmann::json failure = nested.record()["newton"]["not_converged"][0];
    EXPECT_EQ(failure["newton"], "the solution with fewer nodes was not reached");
    EXPECT_EQ(failure["fewer_nodes"], nested.set_out_from().deformer->record()["newton"]["not_converged"][0]);
    EXPECT_LT(failure["fewer_nodes"]["lowest_det_f"].get<double>(), 0.999);
    EXPECT_LT(largest_distance(nested.last_state(), nested.set_out_from().deformer->last_state()),
              test_support::frame_rounding_m(nested.last_state()));
    EXPECT_GT(largest_distance(nested.last_state(), bar().mesh.rest), 0.01);
}

TEST(ElasticFemDeformer, AFrameThatIsNotReachedIsReportedAndTheNextSetsOutFromThere)
{
    const FemOptions options{.model = Model::neo_hookean, .element_order = 1, .attachment = FemAttachment::embedded};
    ElasticFemDeformer fem(options);
    fem.reset(bar());
    EXPECT_EQ(fem.advance(crushed(), 0.01).outcome, pbs::Outcome::not_converged);
    const nlohmann::json failure = fem.record()["newton"]["not_converged"][0];
    EXPECT_EQ(failure["frame"], 0);
    EXPECT_GT(failure["reached"].get<double>(), 0.0);
    EXPECT_LT(failure["reached"].get<double>(), 1.0);
    EXPECT_NE(failure["newton"], "converged");
    EXPECT_GT(*fem.lowest_det_f(), 0.0) << "of the last equilibrium, since the energy is infinite at det F <= 0";
    EXPECT_LT(failure["lowest_det_f"].get<double>(), *fem.lowest_det_f()) << "of Newton's last state";
    EXPECT_GT(largest_distance(fem.last_state(), fem.positions()), 0.01);
    EXPECT_FALSE(failure["restarted_from_rest"].get<bool>());
    EXPECT_TRUE(fem.positions().allFinite());
    EXPECT_GT(largest_distance(fem.positions(), bar().mesh.rest), 0.01);

    EXPECT_EQ(fem.advance(bent(0.0), 0.01).outcome, pbs::Outcome::finished);
    EXPECT_LT(largest_distance(fem.positions(), bar().mesh.rest), test_support::newton_error_m(bar(), options, bent(0.0), bar().mesh.rest));
}

TEST(ElasticFemDeformer, TheSecondFailureInARowIsTriedAgainFromRestOnce)
{
    ElasticFemDeformer fem(coarse);
    fem.reset(bar());
    for (int frame = 0; frame < 4; ++frame) EXPECT_EQ(fem.advance(not_a_number(), 0.01).outcome, pbs::Outcome::not_converged);
    const nlohmann::json newton = fem.record()["newton"];
    EXPECT_EQ(newton["restarts_from_rest"], 1);
    EXPECT_EQ(newton["not_converged"][1]["restarted_from_rest"], true);
    EXPECT_EQ(newton["not_converged"][1]["newton"], "not_finite");
    EXPECT_EQ(fem.advance(bent(10.0), 0.01).outcome, pbs::Outcome::finished);
}

// Theory: at a minimum Newton's method makes no further progress.
TEST(ElasticFemDeformer, StartedFromItsEquilibriumItStaysThere)
{
    ElasticFemDeformer fem(coarse);
    fem.reset(bar());
    EXPECT_GT(fem.advance(bent(40.0), 0.0).iterations, 0);
    const pbs::Positions equilibrium = fem.positions();
    fem.start_from(equilibrium);
    const pbs::StepSummary again = fem.advance(bent(40.0), 0.0);
    EXPECT_EQ(again.outcome, pbs::Outcome::finished);
    EXPECT_EQ(again.iterations, 0);
    EXPECT_LE(largest_distance(fem.positions(), equilibrium), test_support::frame_rounding_m(equilibrium));
}

// From an inverted state, stable neo-Hookean flesh returns, whatever was requested before. A law that is infinite there cannot start: the
// initial guess is the last iterate, the next frame fails from it, and after the second failure the deformer starts from rest.
TEST(ElasticFemDeformer, ABrokenStartIsTakenAsItIs)
{
    const pbs::Pose pose = bent(40.0);
    const pbs::Positions mirrored = bar().mesh.rest * pbs::Vec3(1.0, 1.0, -1.0).asDiagonal();
    ElasticFemDeformer stable(coarse);
    stable.reset(bar());
    stable.advance(pose, 0.0);
    const pbs::Positions equilibrium = stable.positions();
    stable.start_from(mirrored);
    EXPECT_GT(stable.advance(pose, 0.0).iterations, 1);
    EXPECT_LT(largest_distance(stable.positions(), equilibrium), 2.0 * test_support::newton_error_m(bar(), coarse, pose, equilibrium));

    FemOptions infinite = coarse;
    infinite.model = Model::neo_hookean;
    ElasticFemDeformer fem(infinite);
    fem.reset(bar());
    fem.start_from(mirrored);
    EXPECT_EQ(fem.advance(pose, 0.0).outcome, pbs::Outcome::not_converged);
    EXPECT_LT(largest_distance(fem.positions(), mirrored), test_support::frame_rounding_m(mirrored));
    EXPECT_EQ(fem.advance(pose, 0.0).outcome, pbs::Outcome::not_converged);
    EXPECT_EQ(fem.advance(pose, 0.0).outcome, pbs::Outcome::finished);
}

TEST(ElasticFemDeformer, OnlyNodesArePrescribedVertices)
{
    ElasticFemDeformer embedded(coarse);
    embedded.reset(bar());
    EXPECT_TRUE(embedded.prescribed().empty());
    FemOptions by_nodes = coarse;
    by_nodes.attachment = FemAttachment::nodes;
    by_nodes.core_radius = 1.0;
    ElasticFemDeformer nodes(by_nodes);
    nodes.reset(bar());
    nodes.advance(bent(30.0), 0.01);
    const std::vector<bool> prescribed = nodes.prescribed();
    const BoneAttachment bones = nodes_attachment(bar(), by_nodes);
    const pbs::Positions targets = vertex_targets(bones, bar().mesh.rest, bent(30.0));
    for (Eigen::Index v = 0; v < targets.rows(); ++v) {
        EXPECT_EQ(prescribed[v], bones.vertex_bone[v] >= 0);
        if (prescribed[v]) {
            EXPECT_LT((nodes.positions().row(v) - targets.row(v)).norm(), test_support::frame_rounding_m(targets));
        }
    }
}

TEST(ElasticFemDeformer, ResetStartsAnew)
{
    ElasticFemDeformer fem(coarse);
    fem.reset(bar());
    fem.advance(bent(30.0), 0.01);
    const pbs::Positions first = fem.positions();
    fem.reset(bar());
    EXPECT_EQ(fem.record()["frames"], 0);
    EXPECT_EQ(fem.positions(), bar().mesh.rest);
    fem.advance(bent(30.0), 0.01);
    EXPECT_EQ(fem.positions(), first);
}

TEST(ElasticFemDeformer, OnlyDynamicsHasMemory)
{
    EXPECT_FALSE(ElasticFemDeformer(coarse).has_memory());
    FemOptions moving = coarse;
    moving.dynamics = Dynamics::newmark;
    EXPECT_TRUE(ElasticFemDeformer(moving).has_memory());
}

class InTime : public testing::TestWithParam<Dynamics> {
protected:
    InTime()
    {
        options.dynamics = GetParam();
        options.gravity_m_s2 = {0, -9.81, 0};
    }
    FemOptions options = coarse;
};

// The first pose is taken at rest in equilibrium under gravity, so nothing moves after it. A force that is as large as Newton's residual,
// and suddenly applied, moves a vibrating body by at most twice the static displacement. There are two such forces: what the solution for
// the equilibrium leaves, and what the time steps leave.
TEST_P(InTime, StartsInEquilibriumAndStaysThere)
{
    ElasticFemDeformer fem(options);
    fem.reset(bar());
    EXPECT_EQ(fem.advance(bent(30.0), 0.01).outcome, pbs::Outcome::finished);
    const pbs::Positions start = fem.positions();
    EXPECT_GT(largest_distance(start, bar().mesh.rest), 0.1);
    for (int step = 0; step < 5; ++step) EXPECT_EQ(fem.advance(bent(30.0), 0.01).outcome, pbs::Outcome::finished);
    EXPECT_LT(largest_distance(fem.positions(), start), 4.0 * test_support::newton_error_m(bar(), options, bent(30.0), start));
}

TEST_P(InTime, TheStepAfterOneThatWasTakenBackCoversItsTimeToo)
{
    ElasticFemDeformer interrupted(options), whole(options);
    interrupted.reset(bar());
    whole.reset(bar());
    interrupted.advance(bent(0.0), 0.01);
    whole.advance(bent(0.0), 0.01);
    EXPECT_EQ(interrupted.advance(not_a_number(), 0.01).outcome, pbs::Outcome::not_converged);
    EXPECT_EQ(interrupted.advance(bent(10.0), 0.01).outcome, pbs::Outcome::finished);
    EXPECT_EQ(whole.advance(bent(10.0), 0.02).outcome, pbs::Outcome::finished);
    EXPECT_EQ(interrupted.positions(), whole.positions());
}

INSTANTIATE_TEST_SUITE_P(Schemes, InTime, testing::Values(Dynamics::newmark, Dynamics::generalized_alpha));

}  // namespace
