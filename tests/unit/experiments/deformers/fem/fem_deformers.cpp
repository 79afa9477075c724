// How the deformer reaches frames, and what it reports of those that it does not reach. The verification tests show
// that it deforms correctly. Tolerances between two solutions for one pose: newton_error_m, the error that Newton's
// method leaves, for each of them.

#include "experiments/meshes/meshing.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/fem_bar.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/json_facts.hpp"
#include "tests/support/newton_rounding.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rounding_error.hpp"

namespace {

using namespace experiments;
using namespace test_support;
using pbs::Outcome;
using reference_fem::Dynamics;
using reference_fem::Model;

const FemOptions coarse{.model = Model::stable_neo_hookean, .element_order = 1};

const pbs::Character& bar()
{
    static const pbs::Character character = bar_character({8, 2, 2});
    return character;
}

// A deformer that has been reset.
template <typename Fem>
struct On : Fem {
    explicit On(const FemOptions& options, const pbs::Character& character = bar()) : Fem(options)
    {
        this->reset(character);
    }
    Outcome at(const pbs::Pose& pose, double dt_s = 0.01) { return this->advance(pose, dt_s).outcome; }
    // The record of the first frame that was not reached.
    nlohmann::json failure() const { return this->record()["newton"]["not_converged"][0]; }
};
using ElasticBar = On<ElasticFemDeformer>;
using LinearBar = On<LinearFemDeformer>;

pbs::Pose not_a_number()
{
    pbs::Pose broken = turned(10.0);
    broken[1].translation()(0) = std::nan("");
    return broken;
}

// The forearm is pushed 0.7 m into the upper arm: the flesh between the facing ends of the capsules, 1/3 m long, would
// have to invert, which a law that is infinite at det F <= 0 prevents.
pbs::Pose crushed()
{
    pbs::Pose pose = turned(0.0);
    pose[1].translation()(0) = -0.7;
    return pose;
}

TEST(ElasticFemDeformer, RecordsModelGripAndNewton)
{
    EXPECT_TRUE(ElasticFemDeformer(coarse).record().is_null());
    ElasticBar fem(coarse);
    fem.at(turned(0.0));
    EXPECT_EQ(fem.positions(), bar().mesh.rest);
    EXPECT_EQ(fem.at(turned(20.0)), Outcome::finished);
    const nlohmann::json record = fem.record();
    expect_facts(
        record,
        R"({"model": "stable_neo_hookean", "formulation": "displacement", "dynamics": "quasi_static", "frames": 2,
                             "newton": {"frames_not_converged": 0}})");
    EXPECT_FALSE(record.contains("fictitious_strain")) << "the law is objective";
    EXPECT_GT(record["newton"]["newton_steps"]["most"].get<int>(), 0);
    EXPECT_GT(record["attachment"]["bones"][0]["grip_error_rms_m"].get<double>(), 0.0);
}

// As the root of a rig on the ground. Springs outside the tets pull at nothing.
TEST(FemDeformer, ABoneOutsideTheFleshMovesNothingAndIsOnRecord)
{
    pbs::Character character = bar();
    character.skeleton.bones.push_back({"ground", 0, pbs::Vec3(0, -3, 0), pbs::Vec3(0, -2, 0)});
    pbs::Pose pose = turned(20.0);
    pose.push_back(Eigen::Isometry3d(Eigen::Translation3d(0, -5, 0)));
    const FemOptions linear{.model = Model::linear, .element_order = 1};
    EXPECT_EQ(deformed(character, linear, {pose}), deformed(bar(), linear, {turned(20.0)}));
    const pbs::Positions expected = deformed(bar(), coarse, {turned(20.0)});
    EXPECT_LT(largest_distance(deformed(character, coarse, {pose}), expected),
              2.0 * newton_error_m(bar(), coarse, turned(20.0), expected));
    const nlohmann::json grips = ElasticBar(coarse, character).record()["attachment"]["bones"];
    EXPECT_EQ(grips[2]["bone"], "ground");
    EXPECT_EQ(grips[2]["tets_gripped"], 0);
    EXPECT_GT(grips[1]["tets_gripped"], 0);
}

FemOptions without_contact(FemOptions options)
{
    options.contact = false;
    return options;
}

bool passes_through_itself(const pbs::Positions& positions)
{
    return pbs::self_intersects(positions, pbs::boundary_of(bar().mesh.tets));
}

// The bar folds at its joint, at x = 0. Reference: CGAL, which knows nothing of contact.
TEST(ElasticFemDeformer, WithContactAFoldDoesNotOverlapItself)
{
    for (const int order : {1, 2}) {
        const FemOptions folds{.model = Model::neo_hookean, .element_order = order};
        ElasticBar alone(without_contact(folds)), contact(folds);
        ASSERT_EQ(alone.at(turned(160.0)), Outcome::finished);
        ASSERT_EQ(contact.at(turned(160.0)), Outcome::finished);
        EXPECT_TRUE(passes_through_itself(alone.positions())) << "without contact";
        EXPECT_FALSE(passes_through_itself(contact.positions())) << "order " << order;
        const nlohmann::json record = contact.record()["contact"];
        EXPECT_EQ(record["frames"], 1);
        EXPECT_GT(record["smallest_distance_m"].get<double>(), 0.0);
        EXPECT_LT(record["smallest_distance_m"].get<double>(), record["range_m"].get<double>());
        EXPECT_FALSE(alone.record().contains("contact"));
        EXPECT_TRUE(alone.facts()->tips.empty());
    }
}

// Reference: the corners' own positions, of which the middle of a tet of order 1 and the reflection of a corner in
// another are sums.
TEST(ElasticFemDeformer, MovesPlacesInItsTetsAndBeyond)
{
    ElasticBar fem(coarse);
    ASSERT_EQ(fem.at(turned(60.0)), Outcome::finished);
    const pbs::Positions& x = fem.positions();
    const auto corners = bar().mesh.tets.row(3);
    const pbs::Positions moved =
        fem.facts()->moved({{3, {0.0, 0.0, 0.0}}, {3, {0.25, 0.25, 0.25}}, {3, {2.0, 0.0, 0.0}}});
    // of sums of four coordinates up to 2 m, which the root's frame turns
    const double rounding = rounding_error(20, 2.0);
    EXPECT_LT((moved.row(0) - x.row(corners(0))).norm(), rounding);
    EXPECT_LT((moved.row(1) - x(corners, Eigen::all).colwise().mean()).norm(), rounding);
    EXPECT_LT((moved.row(2) - (2.0 * x.row(corners(1)) - x.row(corners(0)))).norm(), rounding);
}

TEST(ElasticFemDeformer, WithoutAFoldContactChangesNothing)
{
    const FemOptions options{.model = Model::neo_hookean, .element_order = 2};
    EXPECT_EQ(deformed(bar(), options, {turned(20.0)}), deformed(bar(), without_contact(options), {turned(20.0)}));
}

// The barrier would keep the windings interlocked.
TEST(ElasticFemDeformer, WithContactAnInitialGuessThatIntersectsItselfIsRefused)
{
    ElasticBar contact({.model = Model::stable_neo_hookean, .element_order = 1});
    contact.start_from(wound(bar().mesh.rest));
    EXPECT_EQ(contact.at(turned(0.0)), Outcome::not_converged);
    EXPECT_EQ(contact.failure()["newton"], "intersects_itself");
    EXPECT_EQ(contact.at(turned(10.0)), Outcome::finished) << "along the bones, from rest";
}

FemOptions with_nested_start(FemOptions options)
{
    options.nested_start = true;
    return options;
}

// One pose with and without a nested start.
struct TwoWays {
    TwoWays(const pbs::Character& character, const FemOptions& options, const pbs::Pose& pose, Outcome expected)
        : along_the_way(options, character), nested(with_nested_start(options), character)
    {
        for (ElasticBar* fem : {&along_the_way, &nested}) EXPECT_EQ(fem->at(pose), expected);
    }
    static int steps(const ElasticFemDeformer& fem)
    {
        return fem.record()["newton"]["newton_steps"]["most"].get<int>();
    }
    double difference_m() const { return largest_distance(along_the_way.positions(), nested.positions()); }

    ElasticBar along_the_way, nested;
};

// Reference: an equilibrium does not depend on the path to it, nor on the solution on coarser tets at which it begins.
TEST(ElasticFemDeformer, ANestedStartLeadsToTheSameSolutionInFewerSteps)
{
    const FemOptions quadratic{.model = Model::stable_neo_hookean,
                               .element_order = 2,
                               .formulation = reference_fem::Formulation::mean_dilatation};
    const pbs::Character fine = pbs::refined(bar());
    for (const auto& [character, options] : {std::pair(&bar(), quadratic), {&fine, coarse}}) {
        const TwoWays ways(*character, options, turned(75.0), Outcome::finished);
        const double error_m = newton_error_m(*character, options, turned(75.0), ways.nested.positions());
        EXPECT_LT(ways.difference_m(), 2.0 * error_m);
        EXPECT_LT(error_m, options.element_order == 2 ? 1e-6 : 1e-3)
            << "a bound that would let another shape of the bar pass";
        EXPECT_LT(ways.steps(ways.nested), ways.steps(ways.along_the_way));
    }
}

TEST(ElasticFemDeformer, WhereOrder1DoesNotArriveANestedStartGoesTheWayItself)
{
    const FemOptions crushes{.model = Model::neo_hookean, .element_order = 2, .attachment = FemAttachment::embedded};
    const TwoWays ways(bar(), crushes, crushed(), Outcome::not_converged);
    EXPECT_EQ(ways.along_the_way.positions(), ways.nested.positions());
}

// Order 1 may take four times the steps, which suffice for this pose. Reference: Newton's method alone from the same
// initial guess, which keeps its last iterate. The first step does not reduce the residual to a tenth, so that neither
// solve uses a factor again.
TEST(ElasticFemDeformer, AfterANestedStartThatFailsTheRecordIsOfTheLastNewtonState)
{
    const FemOptions options{.model = Model::neo_hookean, .element_order = 2, .most_newton_steps = 2};
    ElasticBar nested(with_nested_start(options)), alone(options);
    ASSERT_EQ(nested.at(turned(40.0)), Outcome::not_converged);
    ASSERT_EQ(nested.facts()->fewer_nodes.step.outcome, Outcome::finished);
    alone.start_from(nested.facts()->fewer_nodes.deformer->positions());
    ASSERT_EQ(alone.at(turned(40.0)), Outcome::not_converged);
    EXPECT_LT(largest_distance(nested.facts()->last_state, alone.positions()), frame_rounding_m(alone.positions()));
    EXPECT_GT(largest_distance(nested.facts()->last_state, nested.facts()->fewer_nodes.deformer->positions()), 1e-4);
    EXPECT_EQ(nested.positions(), bar().mesh.rest) << "the last equilibrium";
    const nlohmann::json failure = nested.failure();
    EXPECT_NEAR(failure["lowest_det_f"].get<double>(), *alone.facts()->lowest_det_f, 1e-12);
    EXPECT_LT(failure["lowest_det_f"].get<double>(), 0.999);
}

TEST(ElasticFemDeformer, WhereFewerNodesDoNotArriveTheirLastNewtonStateIsOnRecord)
{
    ElasticBar nested({.model = Model::neo_hookean, .element_order = 2, .most_newton_steps = 1, .nested_start = true});
    ASSERT_EQ(nested.at(turned(75.0)), Outcome::not_converged);
    const nlohmann::json failure = nested.failure();
    EXPECT_EQ(failure["newton"], "the solution with fewer nodes was not reached");
    EXPECT_EQ(failure["fewer_nodes"], nested.facts()->fewer_nodes.deformer->record()["newton"]["not_converged"][0]);
    EXPECT_LT(failure["fewer_nodes"]["lowest_det_f"].get<double>(), 0.999);
    EXPECT_LT(largest_distance(nested.facts()->last_state, nested.facts()->fewer_nodes.deformer->facts()->last_state),
              frame_rounding_m(nested.facts()->last_state));
    EXPECT_GT(largest_distance(nested.facts()->last_state, bar().mesh.rest), 0.01);
}

TEST(ElasticFemDeformer, AFrameThatIsNotReachedIsReportedAndTheNextSetsOutFromThere)
{
    const FemOptions options{.model = Model::neo_hookean, .element_order = 1, .attachment = FemAttachment::embedded};
    ElasticBar fem(options);
    EXPECT_EQ(fem.at(crushed()), Outcome::not_converged);
    const nlohmann::json failure = fem.failure();
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

    EXPECT_EQ(fem.at(turned(0.0)), Outcome::finished);
    EXPECT_LT(largest_distance(fem.positions(), bar().mesh.rest),
              newton_error_m(bar(), options, turned(0.0), bar().mesh.rest));
}

TEST(ElasticFemDeformer, TheSecondFailureInARowIsTriedAgainFromRestOnce)
{
    ElasticBar fem(coarse);
    for (int frame = 0; frame < 4; ++frame) EXPECT_EQ(fem.at(not_a_number()), Outcome::not_converged);
    const nlohmann::json newton = fem.record()["newton"];
    EXPECT_EQ(newton["restarts_from_rest"], 1);
    expect_facts(newton["not_converged"][1], R"({"restarted_from_rest": true, "newton": "not_finite"})");
    EXPECT_EQ(fem.at(turned(10.0)), Outcome::finished);
}

// Theory: at a minimum Newton's method makes no further progress.
TEST(ElasticFemDeformer, StartedFromItsEquilibriumItStaysThere)
{
    ElasticBar fem(coarse);
    EXPECT_GT(fem.advance(turned(40.0), 0.0).iterations, 0);
    const pbs::Positions equilibrium = fem.positions();
    fem.start_from(equilibrium);
    const pbs::StepSummary again = fem.advance(turned(40.0), 0.0);
    EXPECT_EQ(again.outcome, Outcome::finished);
    EXPECT_EQ(again.iterations, 0);
    EXPECT_LE(largest_distance(fem.positions(), equilibrium), frame_rounding_m(equilibrium));
}

// From an inverted state, stable neo-Hookean flesh returns, whatever was requested before. A law that is infinite there
// cannot start: the initial guess is the last iterate, the next frame fails from it, and after the second failure the
// deformer starts from rest.
TEST(ElasticFemDeformer, ABrokenStartIsTakenAsItIs)
{
    const pbs::Pose pose = turned(40.0);
    const pbs::Positions mirrored = bar().mesh.rest * pbs::Vec3(1.0, 1.0, -1.0).asDiagonal();
    ElasticBar stable(without_contact(coarse));  // through which nothing turns inside out
    stable.at(pose, 0.0);
    const pbs::Positions equilibrium = stable.positions();
    stable.start_from(mirrored);
    EXPECT_GT(stable.advance(pose, 0.0).iterations, 1);
    EXPECT_LT(largest_distance(stable.positions(), equilibrium),
              2.0 * newton_error_m(bar(), coarse, pose, equilibrium));

    ElasticBar fem(without_contact({.model = Model::neo_hookean, .element_order = 1}));
    fem.start_from(mirrored);
    EXPECT_EQ(fem.at(pose, 0.0), Outcome::not_converged);
    EXPECT_LT(largest_distance(fem.positions(), mirrored), frame_rounding_m(mirrored));
    EXPECT_EQ(fem.at(pose, 0.0), Outcome::not_converged);
    EXPECT_EQ(fem.at(pose, 0.0), Outcome::finished);
}

TEST(ElasticFemDeformer, ResetStartsAnewAndOnlyDynamicsHasMemory)
{
    ElasticBar fem(coarse);
    fem.at(turned(30.0));
    const pbs::Positions first = fem.positions();
    fem.reset(bar());
    EXPECT_EQ(fem.record()["frames"], 0);
    EXPECT_EQ(fem.positions(), bar().mesh.rest);
    fem.at(turned(30.0));
    EXPECT_EQ(fem.positions(), first);
    EXPECT_FALSE(fem.has_memory());
    EXPECT_TRUE(ElasticFemDeformer({.model = Model::stable_neo_hookean, .dynamics = Dynamics::newmark}).has_memory());
}

// Those of nodes are at their targets.
template <typename Fem>
void expect_prescribed(const pbs::Character& character, FemOptions options, double core_radius, double angle_deg)
{
    EXPECT_TRUE(On<Fem>(options, character).facts()->prescribed.empty());
    options.attachment = FemAttachment::nodes;
    options.core_radius = core_radius;
    On<Fem> nodes(options, character);
    nodes.at(turned(angle_deg));
    const std::vector<bool> prescribed = nodes.facts()->prescribed;
    const BoneAttachment bones = bone_attachment(character, options);
    const pbs::Positions held = targets(bones, character.mesh.rest, turned(angle_deg)).vertices;
    ASSERT_EQ(static_cast<Eigen::Index>(prescribed.size()), held.rows());
    for (Eigen::Index v = 0; v < held.rows(); ++v) {
        EXPECT_EQ(prescribed[v], bones.vertex_bone[v] >= 0);
        EXPECT_LT(prescribed[v] ? (nodes.positions().row(v) - held.row(v)).norm() : 0.0, frame_rounding_m(held));
    }
}

TEST(FemDeformers, OnlyNodesArePrescribedVertices)
{
    expect_prescribed<ElasticFemDeformer>(bar(), coarse, 1.0, 30.0);
    expect_prescribed<LinearFemDeformer>(bar_character({48, 8, 8}), {.element_order = 1}, 0.6, 10.0);
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

// The first pose is taken at rest in equilibrium under gravity, so nothing moves after it. A force that is as large as
// Newton's residual, and suddenly applied, moves a vibrating body by at most twice the static displacement. There are
// two such forces: what the solution for the equilibrium leaves, and what the time steps leave.
TEST_P(InTime, StartsInEquilibriumAndStaysThere)
{
    ElasticBar fem(options);
    EXPECT_EQ(fem.at(turned(30.0)), Outcome::finished);
    const pbs::Positions start = fem.positions();
    EXPECT_GT(largest_distance(start, bar().mesh.rest), 0.1);
    for (int step = 0; step < 5; ++step) EXPECT_EQ(fem.at(turned(30.0)), Outcome::finished);
    EXPECT_LT(largest_distance(fem.positions(), start), 4.0 * newton_error_m(bar(), options, turned(30.0), start));
}

TEST_P(InTime, TheStepAfterOneThatWasTakenBackCoversItsTimeToo)
{
    ElasticBar interrupted(options), whole(options);
    interrupted.at(turned(0.0));
    whole.at(turned(0.0));
    EXPECT_EQ(interrupted.at(not_a_number()), Outcome::not_converged);
    EXPECT_EQ(interrupted.at(turned(10.0)), Outcome::finished);
    EXPECT_EQ(whole.at(turned(10.0), 0.02), Outcome::finished);
    EXPECT_EQ(interrupted.positions(), whole.positions());
}

INSTANTIATE_TEST_SUITE_P(Schemes, InTime, testing::Values(Dynamics::newmark, Dynamics::generalized_alpha));

// The deformer's reports, and the inputs that it refuses. The verification tests show that it deforms correctly.

const FemOptions linear_tets{.element_order = 1};

const pbs::Character& fine_bar()
{
    static const pbs::Character character = bar_character({24, 4, 4});
    return character;
}

TEST(LinearFemDeformer, BarHasTheConditionNumberThatOthersRelyOn)
{
    const auto character = bar_character({12, 3, 3});
    const FemOptions options{.element_order = 2};
    const auto spectrum =
        spectrum_of(character.mesh, linear_options(options), bone_attachment(character, options).attachment);
    EXPECT_LT(spectrum.condition(), quadratic_bar_condition);
}

TEST(LinearFemDeformer, RecordsWhatIsGrippedOfEachBone)
{
    EXPECT_TRUE(LinearFemDeformer(linear_tets).record().is_null());
    LinearBar fem(linear_tets, fine_bar());
    for (const double angle_deg : {10.0, 5.0}) fem.at(turned(angle_deg));
    const nlohmann::json record = fem.record();
    expect_facts(record,
                 R"({"frames": 2, "attachment": {"bones": [
                     {"samples": 7720, "inside": 7720, "shared_vertices": 0},
                     {"samples": 7720, "inside": 7720, "shared_vertices": 0}]}})");
    // The angle is that of a quaternion of norm one, some twenty roundings after the angle of the pose.
    const double degree = std::acos(-1.0) / 180.0, rounding = rounding_error(20, 1.0);
    EXPECT_NEAR(record["largest_rotation_deg"].get<double>(), 10.0, rounding / degree);
    EXPECT_NEAR(record["fictitious_strain"].get<double>(), 1.0 - std::cos(10.0 * degree), rounding);
    // |r| <= sqrt(n) eps |K| |u| (reference_fem/verification/problems.hpp). The stiffest entries of K are those of the
    // springs, which are also the load, so that |K| |u| is at most 100 |f|.
    const double unknowns = 3.0 * static_cast<double>(fine_bar().mesh.rest.rows());
    EXPECT_LT(record["largest_residual"].get<double>(), rounding_error(2.0 * std::sqrt(unknowns), 100.0));
    EXPECT_EQ(record["setup"]["dofs"], 3 * fine_bar().mesh.rest.rows());
    for (const auto& bone : record["attachment"]["bones"]) {
        EXPECT_GT(bone["tets_gripped"].get<int>(), 0);
        EXPECT_GE(bone["skin_share"].get<double>(), 0.0);
        EXPECT_LT(bone["skin_share"].get<double>(), 1.0);
        EXPECT_GT(bone["grip_error_rms_m"].get<double>(), 0.0);
        EXPECT_LE(bone["grip_error_rms_m"].get<double>(), record["largest_grip_error_m"].get<double>());
    }
}

TEST(LinearFemDeformer, ReportsAPoseThatIsNotANumberStartsTheRecordAnewAndLeavesOutABoneOutsideTheFlesh)
{
    LinearBar fem(linear_tets, fine_bar());
    EXPECT_EQ(fem.at(not_a_number()), Outcome::not_finite);
    EXPECT_EQ(fem.at(turned(10.0)), Outcome::finished);
    EXPECT_EQ(fem.record()["frames_not_finite"], 1);
    fem.reset(fine_bar());
    expect_facts(fem.record(), R"({"frames": 0, "frames_not_finite": 0})");
    EXPECT_EQ(fem.positions(), fine_bar().mesh.rest);
    auto character = fine_bar();
    character.skeleton.bones.push_back({"ghost", 0, {0, 5, 0}, {0, 6, 0}});
    LinearBar with_ghost(linear_tets, character);
    EXPECT_EQ(with_ghost.record()["attachment"]["bones"].back()["bone"], "ghost");
    EXPECT_EQ(with_ghost.record()["attachment"]["bones"].back()["tets_gripped"], 0);
    EXPECT_EQ(with_ghost.at(turned(10.0)), Outcome::finished);
}

// Reference: sums and extremes over invented paths with known numbers.

using namespace reference_fem;

NewtonSummary newton(NewtonOutcome outcome, int steps, int projected)
{
    NewtonSummary summary;
    summary.outcome = outcome;
    for (int k = 0; k < steps; ++k)
        summary.iterations.push_back({.residual_n = 10.0 - k, .step_length = 1.0, .projected = k < projected});
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
        {{path(1.0, {{1.0, newton(NewtonOutcome::no_descent, 5, 2)}, {0.5, newton(NewtonOutcome::converged, 3, 0)}})},
         1.0,
         false},
        {0.5, 7, 0, 1.01});
    const nlohmann::json json = record.to_json();
    expect_facts(
        json, R"({"newton_steps": {"mean": 6, "most": 8}, "factorisations": 14, "projected_hessians": 2, "halvings": 1,
                           "lowest_det_f": 0.5, "solve_s": {"mean": 2}, "frames_not_converged": 0})");
    // 0.98 and 1.01 are not binary numbers: a rounding of one, times a hundred, and one of the product.
    EXPECT_NEAR(json["volume_change_pct"]["lowest"].get<double>(), -2.0, 100.0 * rounding_error(2, 1.0));
    EXPECT_NEAR(json["volume_change_pct"]["highest"].get<double>(), 1.0, 100.0 * rounding_error(2, 1.0));
}

TEST(NewtonRecord, AFrameThatIsNotReachedIsNamedWithItsReason)
{
    NewtonRecord record(1.0);
    record.add_frame({{path(1.0, {{1.0, newton(NewtonOutcome::converged, 1, 0)}})}, 1.0, false}, sound);
    record.add_frame(
        {{path(0.25, {{0.25, newton(NewtonOutcome::converged, 1, 0)}, {0.5, newton(NewtonOutcome::no_descent, 3, 3)}})},
         0.25,
         true},
        {-0.4, 17, 2, 0.5});
    // lowest_det_f: of frames that converged
    expect_facts(record.to_json(), R"({"restarts_from_rest": 1, "lowest_det_f": 0.9,
                                       "not_converged": [
                                           {"frame": 1, "reached": 0.25, "restarted_from_rest": true,
                                            "newton": "no_descent", "last_residual_n": 8,
                                            "worst_tet": 17, "inverted_points": 2}]})");
}

}  // namespace
