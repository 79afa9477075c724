// How the deformer reaches frames, and what it reports of those that it does not reach. The verification tests show that it deforms
// correctly. Tolerances between two solutions for one pose: newton_error_m, the error that Newton's method leaves, for each of them.

#include "experiments/deformers/fem/fem_deformers.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/newton_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/solve_rounding.hpp"

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

// One pose with and without a nested start.
struct TwoWays {
    TwoWays(const pbs::Character& character, FemOptions options, const pbs::Pose& pose, pbs::Outcome expected) : along_the_way(options)
    {
        options.nested_start = true;
        nested = std::make_unique<ElasticFemDeformer>(options);
        for (ElasticFemDeformer* fem : {&along_the_way, nested.get()}) {
            fem->reset(character);
            EXPECT_EQ(fem->advance(pose, 0.01).outcome, expected);
        }
    }
    static int steps(const ElasticFemDeformer& fem) { return fem.record()["newton"]["newton_steps"]["most"].get<int>(); }
    double difference_m() const { return largest_distance(along_the_way.positions(), nested->positions()); }

    ElasticFemDeformer along_the_way;
    std::unique_ptr<ElasticFemDeformer> nested;
};

// Reference: an equilibrium does not depend on the path to it, nor on the solution on coarser tets at which it begins.
TEST(ElasticFemDeformer, ANestedStartLeadsToTheSameSolutionInFewerSteps)
{
    const FemOptions quadratic{
        .model = Model::stable_neo_hookean, .element_order = 2, .formulation = reference_fem::Formulation::mean_dilatation};
    const pbs::Character fine = pbs::refined(bar());
    for (const auto& [character, options] : {std::pair(&bar(), quadratic), {&fine, coarse}}) {
        const TwoWays ways(*character, options, bent(75.0), pbs::Outcome::finished);
        const double error_m = test_support::newton_error_m(*character, options, bent(75.0), ways.nested->positions());
        EXPECT_LT(ways.difference_m(), 2.0 * error_m);
        EXPECT_LT(error_m, options.element_order == 2 ? 1e-6 : 1e-3) << "a bound that would let another shape of the bar pass";
        EXPECT_LT(ways.steps(*ways.nested), ways.steps(ways.along_the_way));
    }
}

TEST(ElasticFemDeformer, WhereOrder1DoesNotArriveANestedStartGoesTheWayItself)
{
    const FemOptions crushes{.model = Model::neo_hookean, .element_order = 2, .attachment = FemAttachment::embedded};
    const TwoWays ways(bar(), crushes, crushed(), pbs::Outcome::not_converged);
    EXPECT_EQ(ways.along_the_way.positions(), ways.nested->positions());
}

// Order 1 may take four times the steps, which suffice for this pose. Reference: Newton's method alone from the same initial guess, which
// keeps its last iterate. The first step does not reduce the residual to a tenth, so that neither solve uses a factor again.
TEST(ElasticFemDeformer, AfterANestedStartThatFailsTheRecordIsOfTheLastNewtonState)
{
    FemOptions options{.model = Model::neo_hookean, .element_order = 2, .most_newton_steps = 2, .nested_start = true};
    ElasticFemDeformer nested(options);
    nested.reset(bar());
    ASSERT_EQ(nested.advance(bent(40.0), 0.01).outcome, pbs::Outcome::not_converged);
    ASSERT_EQ(nested.facts()->fewer_nodes.step.outcome, pbs::Outcome::finished);

    options.nested_start = false;
    ElasticFemDeformer alone(options);
    alone.reset(bar());
    alone.start_from(nested.facts()->fewer_nodes.deformer->positions());
    ASSERT_EQ(alone.advance(bent(40.0), 0.01).outcome, pbs::Outcome::not_converged);
    EXPECT_LT(largest_distance(nested.facts()->last_state, alone.positions()), test_support::frame_rounding_m(alone.positions()));
    EXPECT_GT(largest_distance(nested.facts()->last_state, nested.facts()->fewer_nodes.deformer->positions()), 1e-4);
    EXPECT_EQ(nested.positions(), bar().mesh.rest) << "the last equilibrium";
    const nlohmann::json failure = nested.record()["newton"]["not_converged"][0];
    EXPECT_NEAR(failure["lowest_det_f"].get<double>(), *alone.facts()->lowest_det_f, 1e-12);
    EXPECT_LT(failure["lowest_det_f"].get<double>(), 0.999);
}

TEST(ElasticFemDeformer, WhereFewerNodesDoNotArriveTheirLastNewtonStateIsOnRecord)
{
    ElasticFemDeformer nested({.model = Model::neo_hookean, .element_order = 2, .most_newton_steps = 1, .nested_start = true});
    nested.reset(bar());
    ASSERT_EQ(nested.advance(bent(75.0), 0.01).outcome, pbs::Outcome::not_converged);
    const nlohmann::json failure = nested.record()["newton"]["not_converged"][0];
    EXPECT_EQ(failure["newton"], "the solution with fewer nodes was not reached");
    EXPECT_EQ(failure["fewer_nodes"], nested.facts()->fewer_nodes.deformer->record()["newton"]["not_converged"][0]);
    EXPECT_LT(failure["fewer_nodes"]["lowest_det_f"].get<double>(), 0.999);
    EXPECT_LT(largest_distance(nested.facts()->last_state, nested.facts()->fewer_nodes.deformer->facts()->last_state),
              test_support::frame_rounding_m(nested.facts()->last_state));
    EXPECT_GT(largest_distance(nested.facts()->last_state, bar().mesh.rest), 0.01);
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
    EXPECT_GT(*fem.facts()->lowest_det_f, 0.0) << "of the last equilibrium, since the energy is infinite at det F <= 0";
    EXPECT_LT(failure["lowest_det_f"].get<double>(), *fem.facts()->lowest_det_f) << "of Newton's last state";
    EXPECT_GT(largest_distance(fem.facts()->last_state, fem.positions()), 0.01);
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
    EXPECT_TRUE(embedded.facts()->prescribed.empty());
    FemOptions by_nodes = coarse;
    by_nodes.attachment = FemAttachment::nodes;
    by_nodes.core_radius = 1.0;
    ElasticFemDeformer nodes(by_nodes);
    nodes.reset(bar());
    nodes.advance(bent(30.0), 0.01);
    const std::vector<bool> prescribed = nodes.facts()->prescribed;
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

// The deformer's reports, and the inputs that it refuses. The verification tests show that it deforms correctly.

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
    EXPECT_TRUE(embedded.facts()->prescribed.empty());
    LinearFemDeformer nodes({.element_order = 1, .attachment = FemAttachment::nodes, .core_radius = 0.6});
    nodes.reset(character);
    const std::vector<bool> prescribed = nodes.facts()->prescribed;
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

// Reference: sums and extremes over invented paths with known numbers.

using experiments::FrameSolve;
using experiments::NewtonRecord;
using namespace reference_fem;

NewtonSummary newton(NewtonOutcome outcome, int steps, int projected)
{
    NewtonSummary summary;
    summary.outcome = outcome;
    for (int k = 0; k < steps; ++k) summary.iterations.push_back({.residual_n = 10.0 - k, .step_length = 1.0, .projected = k < projected});
    summary.factorisations = steps + projected;
    return summary;
}

LoadPathSummary path(double reached, std::vector<LoadStep> steps)
{
    return {reached, std::move(steps), 2.0};
}

const Jacobians sound{0.9, 3, 0, 0.98};

TEST(NewtonRecord, AddsUpWhatFramesCost)
{
    NewtonRecord record(1.0);
    record.add_frame({{path(1.0, {{1.0, newton(NewtonOutcome::converged, 4, 0)}})}, 1.0, false}, sound);
    record.add_frame(
        {{path(1.0, {{1.0, newton(NewtonOutcome::no_descent, 5, 2)}, {0.5, newton(NewtonOutcome::converged, 3, 0)}})}, 1.0, false},
        {0.5, 7, 0, 1.01});
    const nlohmann::json json = record.to_json();
    EXPECT_EQ(json["newton_steps"]["mean"], 6.0);
    EXPECT_EQ(json["newton_steps"]["most"], 8);
    EXPECT_EQ(json["factorisations"], 14);
    EXPECT_EQ(json["projected_hessians"], 2);
    EXPECT_EQ(json["halvings"], 1);
    EXPECT_EQ(json["lowest_det_f"], 0.5);
    // 0.98 and 1.01 are not binary numbers: a rounding of one, times a hundred, and one of the product.
    EXPECT_NEAR(json["volume_change_pct"]["lowest"].get<double>(), -2.0, 100.0 * test_support::rounding_error(2, 1.0));
    EXPECT_NEAR(json["volume_change_pct"]["highest"].get<double>(), 1.0, 100.0 * test_support::rounding_error(2, 1.0));
    EXPECT_EQ(json["solve_s"]["mean"], 2.0);
    EXPECT_EQ(json["frames_not_converged"], 0);
}

TEST(NewtonRecord, AFrameThatIsNotReachedIsNamedWithItsReason)
{
    NewtonRecord record(1.0);
    record.add_frame({{path(1.0, {{1.0, newton(NewtonOutcome::converged, 1, 0)}})}, 1.0, false}, sound);
    record.add_frame(
        {{path(0.25, {{0.25, newton(NewtonOutcome::converged, 1, 0)}, {0.5, newton(NewtonOutcome::no_descent, 3, 3)}})}, 0.25, true},
        {-0.4, 17, 2, 0.5});
    const nlohmann::json json = record.to_json();
    ASSERT_EQ(json["not_converged"].size(), 1u);
    const nlohmann::json& failure = json["not_converged"][0];
    EXPECT_EQ(failure["frame"], 1);
    EXPECT_EQ(failure["reached"], 0.25);
    EXPECT_EQ(failure["restarted_from_rest"], true);
    EXPECT_EQ(failure["newton"], "no_descent");
    EXPECT_EQ(failure["last_residual_n"], 8.0);
    EXPECT_EQ(failure["worst_tet"], 17);
    EXPECT_EQ(failure["inverted_points"], 2);
    EXPECT_EQ(json["restarts_from_rest"], 1);
    EXPECT_EQ(json["lowest_det_f"], 0.9) << "of frames that converged";
}

}  // namespace
