// Reference: the deformer on each mesh by itself, and a solution on tets cut into 64, which the bound must cover.
#include "experiments/studies/shared/posed_reference.hpp"

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/long_form.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

namespace {

using namespace experiments;

constexpr double time_step_s = 0.01;

const pbs::Character bar = test_support::bar_character({12, 2, 2});

DeformerSpec flesh(int element_order = 2)
{
    DeformerSpec spec = default_spec("fem");
    spec.options = FemOptions{.model = reference_fem::Model::neo_hookean,
                              .element_order = element_order,
                              .attachment = FemAttachment::smooth,
                              .spring_factor = 10.0,
                              .nested_start = element_order == 2};
    return spec;
}

// With fewer steps of Newton's method than the default.
DeformerSpec hurried(int most_newton_steps, int element_order = 2)
{
    DeformerSpec spec = flesh(element_order);
    options_of<FemOptions>(spec).most_newton_steps = most_newton_steps;
    return spec;
}

pbs::Pose bent(double angle_deg)
{
    return pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitZ(), angle_deg, 2, time_step_s).steps.back();
}

// Returns the positions of the first vertices, which are those of the unrefined bar.
pbs::Positions solved(const pbs::Character& character, const pbs::Pose& pose, Eigen::Index vertices)
{
    const auto deformer = make_deformer(flesh());
    deformer->reset(character);
    EXPECT_EQ(deformer->advance(pose, time_step_s).outcome, pbs::Outcome::finished);
    return deformer->positions().topRows(vertices);
}

// Expected values: the definition, by energies and distances.
void expect_the_lowest_energy_and_the_distance_of_other_tets(const PosedReference& reference)
{
    const auto& solutions = reference.solutions();
    ASSERT_EQ(solutions.size(), 8u);
    const std::pair<unsigned, double> seeds_and_edges[] = {{1, 9.0}, {2, 9.0}, {3, 13.5}};
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(std::pair(solutions[5 + i].other_tets, solutions[5 + i].edges_per_radius), seeds_and_edges[i]);
    EXPECT_LT(solutions[5].vertices, solutions[7].vertices);
    EXPECT_EQ(reference.reference().element_order, 2);
    const double lowest = reference.reference().energy_j / reference.reference().volume_m3;
    // of the two equilibria
    double largest_pct = reference.distance(solutions[4].positions, solutions[1].positions).joint_pct;
    for (std::size_t i = 0; i < solutions.size(); ++i) {
        ASSERT_TRUE(solutions[i].finished);
        if (solutions[i].element_order == 2) {
            EXPECT_GE(solutions[i].energy_j / solutions[i].volume_m3, lowest);
        }
        if (i == 0 || i > 4) largest_pct = std::max(largest_pct, reference.error_of(solutions[i].positions).joint_pct);
    }
    EXPECT_EQ(reference.spread().joint_pct, largest_pct);
    EXPECT_EQ(reference.bound().joint_pct, 1.25 * largest_pct);
}

TEST(PosedReference, IsTheFinestOfFourNestedSolutionsAndItsBoundCoversAFinerOne)
{
    const pbs::Pose pose = bent(40.0);
    // This bar is coarser than `bar`, since tets cut into 64 are solved, too.
    const pbs::Character coarse = test_support::bar_character({6, 2, 2});
    const PosedReference reference(coarse, flesh(), pose, time_step_s, ReferenceEffort::refined);
    const auto& solutions = reference.solutions();
    ASSERT_EQ(solutions.size(), 4u);
    const std::pair<int, int> expected[] = {{2, 1}, {2, 0}, {1, 1}, {1, 0}};
    for (std::size_t i = 0; i < solutions.size(); ++i) {
        EXPECT_EQ(std::pair(solutions[i].element_order, solutions[i].refinements), expected[i]);
        EXPECT_TRUE(solutions[i].finished);
        EXPECT_EQ(solutions[i].inverted_tets, 0);
    }
    ASSERT_TRUE(reference.is_reached());
    EXPECT_EQ(&reference.reference(), &solutions.front());
    const Eigen::Index vertices = coarse.mesh.rest.rows();
    const pbs::Character fine = pbs::refined(coarse);
    EXPECT_EQ(reference.reference().positions, solved(fine, pose, vertices));
    EXPECT_EQ(reference.masked_share_pct(), 0.0);

    ASSERT_TRUE(reference.order());
    const pbs::Positions finer = solved(pbs::refined(fine), pose, vertices);
    const double to_a_finer_one = reference.error_of(finer).joint_pct;
    EXPECT_GT(reference.bound().joint_pct, to_a_finer_one);
    // of linear elements
    EXPECT_LT(reference.bound().joint_pct, reference.error_of(solutions.back().positions).joint_pct);
    RecordProperty("bound_pct", std::to_string(reference.bound().joint_pct));
    RecordProperty("to_a_finer_one_pct", std::to_string(to_a_finer_one));

    if (!test_support::is_long_form()) return;  // other tets take long
    const PosedReference with_other_tets(coarse, flesh(), pose, time_step_s);
    expect_the_lowest_energy_and_the_distance_of_other_tets(with_other_tets);
    EXPECT_GT(with_other_tets.bound().joint_pct, with_other_tets.error_of(finer).joint_pct);
}

// Where the equilibrium is unique, the way along the bones ends in the same one, and other tets differ by no more than
// the bar's own do from tets cut into eight.
TEST(PosedReference, AddsTheDistanceOfOtherTetsToItsBoundWhereNoJointIsBent)
{
    const PosedReference reference(bar, flesh(), bent(25.0), time_step_s);
    const auto& solutions = reference.solutions();
    ASSERT_EQ(solutions.size(), 7u);
    for (const NestedSolution& solution : solutions) ASSERT_TRUE(solution.finished);
    EXPECT_TRUE(solutions[4].along_the_bones) << "of equal energy within rounding, so that the nested one stays";
    // of 2 m: Newton's residual is 1e-8
    EXPECT_LT(reference.distance(solutions[4].positions, solutions[1].positions).linf_m, 1e-6);
    EXPECT_EQ(&reference.reference(), &solutions[0]);
    for (const unsigned seed : {1, 2}) EXPECT_EQ(solutions[4 + seed].other_tets, seed);
    double largest_pct = reference.distance(solutions[4].positions, solutions[1].positions).joint_pct;
    for (const std::size_t other : {5, 6}) {
        const double to_other_pct = reference.error_of(solutions[other].positions).joint_pct;
        EXPECT_GT(to_other_pct, 0.0);
        EXPECT_LT(to_other_pct, reference.error_of(solutions[2].positions).joint_pct)
            << "linear elements cut into eight";
        largest_pct = std::max(largest_pct, to_other_pct);
    }
    EXPECT_EQ(reference.spread().joint_pct, largest_pct);
    const PosedReference nested(bar, flesh(), bent(25.0), time_step_s, ReferenceEffort::refined);
    // sums of numbers below 10
    EXPECT_NEAR(reference.bound().joint_pct, nested.bound().joint_pct + largest_pct, 1e-12);
}

// The spread of meshes is not known where one of them did not finish, whatever comes before and after it.
TEST(LargerOfTwoErrors, IsNotANumberWhereOneIsNot)
{
    const double nan = std::nan("");
    const auto largest = larger_of(larger_of({1.0, 4.0, 2.0}, {nan, 3.0, nan}), {9.0, 5.0, 9.0});
    EXPECT_TRUE(std::isnan(largest.l2_pct));
    EXPECT_EQ(largest.joint_pct, 5.0);
    EXPECT_TRUE(std::isnan(largest.linf_m));
}

// Of a family whose members are held in other ways, each is solved on the own tets alone.
TEST(PosedReference, OnTheOwnTetsHasItsBoundFromFinerOnes)
{
    const PosedReference refined(bar, flesh(), bent(40.0), time_step_s, ReferenceEffort::refined);
    const PosedReference own(bar, flesh(), bent(40.0), time_step_s, ReferenceEffort::own_tets);
    EXPECT_EQ(own.reference().positions, refined.solutions()[1].positions);
    EXPECT_EQ(refined.bound_on_own_tets().joint_pct,
              refined.error_of(own.reference().positions).joint_pct + refined.bound().joint_pct);
    EXPECT_TRUE(std::isnan(own.bound().joint_pct));
    EXPECT_TRUE(std::isnan(own.bound_on_own_tets().joint_pct));
    const PosedReference linear(bar, hurried(2), bent(40.0), time_step_s, ReferenceEffort::own_tets);
    ASSERT_TRUE(linear.is_reached());
    EXPECT_EQ(linear.reference().element_order, 1) << "quadratic elements did not arrive";
    EXPECT_TRUE(std::isnan(linear.bound_on_own_tets().joint_pct)) << "of quadratic elements alone";
}

// Each member of the family differs from the first one in what its name states.
TEST(Family, HoldsAndCompressesTheFleshInOtherWays)
{
    const DeformerSpec of_scene = flesh();
    for (const EnsembleMember& member : family()) {
        SCOPED_TRACE(member.name);
        const DeformerSpec spec = flesh_of(of_scene, member);
        const auto& options = options_of<FemOptions>(spec);
        const bool is_embedded = member.name == "rigid_capsules", is_held = member.name == "held_parts";
        EXPECT_EQ(options.attachment, is_embedded ? FemAttachment::embedded
                                      : is_held   ? FemAttachment::held
                                                  : FemAttachment::smooth);
        EXPECT_EQ(options.used_spring_factor(), is_embedded                                  ? 1e4
                                                : member.name.starts_with("stiffer_springs") ? 100.0
                                                                                             : 10.0);
        EXPECT_EQ(options.used_core_radius(), is_embedded ? 0.35 : member.name.ends_with("thinner_bones") ? 0.5 : 0.7);
        EXPECT_EQ(options.poisson, member.name == "nu_0.3" ? 0.3 : member.name == "nu_0.49" ? 0.49 : 0.45);
        EXPECT_EQ(options.formulation, member.name == "nu_0.49" ? reference_fem::Formulation::mean_dilatation
                                                                : reference_fem::Formulation::displacement);
        EXPECT_EQ(options.model, reference_fem::Model::neo_hookean);
    }
}

// Bones that hold a whole part of the flesh move it rigidly: the bar's ends have no strain, and with springs around the
// axis alone they do.
TEST(Family, HeldPartsAreRigid)
{
    const auto furthest_m = [](const EnsembleMember& member) {
        const PosedReference reference(bar, flesh_of(flesh(), member), bent(40.0), time_step_s,
                                       ReferenceEffort::own_tets);
        EXPECT_TRUE(reference.is_reached()) << member.name;
        const pbs::Pose pose = bent(40.0);
        const std::vector<int> alone = pbs::bones_that_move_alone(bar);
        double furthest = 0.0;
        for (std::size_t tet = 0; tet < alone.size(); ++tet)
            for (const int v : bar.mesh.tets.row(tet))
                if (alone[tet] >= 0)
                    furthest = std::max(furthest, (reference.reference().positions.row(v).transpose() -
                                                   pose[alone[tet]] * pbs::Vec3(bar.mesh.rest.row(v)))
                                                      .norm());
        return furthest;
    };
    const double held_m = furthest_m(family().back()), smooth_m = furthest_m(family().front());
    EXPECT_LT(held_m, 0.1 * smooth_m);
    EXPECT_GT(smooth_m, 1e-4);
}

// A solution that is read from its file has the same wall time as the one that wrote it; a new solve would take another
// time.
TEST(PosedReference, FindsTheSolutionsThatItKeepsAndNoOthers)
{
    const test_support::ScratchFolder folder;
    pbs::Character moved = bar,
                   thicker = bar;  // by one vertex, and by its distance from the bone, which a bone's radius depends on
    moved.mesh.rest(0, 0) += 1e-9;
    thicker.binding.distance(0) += 1e-9;
    const auto reference = [&](double angle_deg, double spring_factor = 10.0, double poisson = 0.45,
                               const pbs::Character& body = bar) {
        DeformerSpec spec = flesh();
        options_of<FemOptions>(spec).spring_factor = spring_factor;
        options_of<FemOptions>(spec).poisson = poisson;
        return PosedReference(body, spec, bent(angle_deg), time_step_s, ReferenceEffort::own_tets, folder.path());
    };
    const auto is_found = [](const PosedReference& one, const PosedReference& first) {
        return one.solutions().front().seconds == first.solutions().front().seconds;
    };
    const PosedReference creased = reference(165.0), again = reference(165.0);
    EXPECT_TRUE(is_found(again, creased));
    EXPECT_EQ(again.masked(), creased.masked());
    EXPECT_GT(std::ranges::count(again.masked(), true), 0);
    for (std::size_t i = 0; i < creased.solutions().size(); ++i) {
        const NestedSolution &one = creased.solutions()[i], &kept = again.solutions()[i];
        EXPECT_EQ(kept.positions, one.positions);
        const auto values = [](const NestedSolution& of) {
            return std::tie(of.element_order, of.finished, of.energy_j, of.lowest_det_f, of.j_min, of.newton_steps,
                            of.vertices, of.tets, of.volume_m3, of.edges_per_radius);
        };
        EXPECT_EQ(values(kept), values(one));
        EXPECT_GT(kept.volume_m3, 0.0);
    }
    const PosedReference first = reference(15.0);  // takes few steps
    EXPECT_FALSE(is_found(reference(14.0), first));
    EXPECT_FALSE(is_found(reference(15.0, 20.0), first));
    EXPECT_FALSE(is_found(reference(15.0, 10.0, 0.4), first));
    EXPECT_FALSE(is_found(reference(15.0, 10.0, 0.45, moved), first));
    EXPECT_FALSE(is_found(reference(15.0, 10.0, 0.45, thicker), first));
    EXPECT_TRUE(is_found(reference(15.0), first));
    for (const auto& file : std::filesystem::directory_iterator(folder.path())) std::filesystem::resize_file(file, 100);
    EXPECT_FALSE(is_found(reference(15.0), first)) << "a damaged file";
    const PosedReference nowhere(bar, flesh(), bent(15.0), time_step_s, ReferenceEffort::own_tets,
                                 "/dev/null/solutions");
    EXPECT_EQ(nowhere.reference().positions, first.reference().positions) << "a folder that cannot be made";
}

// By hand: the forearm turns about z, so that the inner side is that of y > 0; the limb's radius is the mean distance
// of the skin.
TEST(FineAtBentJoints, IsOnTheInnerSideOfAJointThatIsBent)
{
    const auto fine = fine_at_bent_joints(bar, bent(60.0), 10.0);
    ASSERT_EQ(fine.size(), 1u);
    const double radius_m = pbs::bone_capsules(bar, 1.0)[1].radius_m;
    EXPECT_LT((fine[0].centre - pbs::Vec3(0.0, radius_m, 0.0)).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(fine[0].size_m, radius_m / 10.0);
    EXPECT_TRUE(fine_at_bent_joints(bar, bent(20.0), 10.0).empty());
    EXPECT_TRUE(fine_at_bent_joints(
                    bar, pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitX(), 90.0, 2, time_step_s).steps.back(), 10.0)
                    .empty())
        << "a twist";
}

// The bar presses on itself where it is bent this far.
TEST(PosedReference, LeavesOutTheTipOfTheCrease)
{
    const PosedReference reference(bar, flesh(), bent(165.0), time_step_s, ReferenceEffort::own_tets);
    ASSERT_TRUE(reference.is_reached());
    const std::vector<bool>& masked = reference.masked();
    ASSERT_GT(std::count(masked.begin(), masked.end(), true), 0);
    ASSERT_GT(std::count(masked.begin(), masked.end(), false), 0);
    EXPECT_GT(reference.masked_share_pct(), 0.0);
    const double radius_m = pbs::bone_capsules(bar, 1.0)[1].radius_m;
    for (std::size_t v = 0; v < masked.size(); ++v)
        if (masked[v]) {
            EXPECT_LT(std::abs(bar.mesh.rest(static_cast<Eigen::Index>(v), 0)), radius_m) << "the joint is at x = 0";
        }
    for (std::size_t v = 0; v < masked.size(); ++v) {
        pbs::Positions moved = reference.reference().positions;
        moved.row(static_cast<Eigen::Index>(v)).array() += 0.5;
        EXPECT_EQ(reference.error_of(moved).linf_m > 0.0, !masked[v]) << v;
        EXPECT_GT(reference.error_on_whole_body(moved).linf_m, 0.0);
    }
    EXPECT_FALSE(reference.order());  // of two solutions no order is observed
    EXPECT_TRUE(std::isnan(reference.bound().joint_pct));
}

TEST(PosedReference, ThatDoesNotArriveIsNotReached)
{
    const PosedReference reference(bar, hurried(1), bent(120.0), time_step_s, ReferenceEffort::own_tets);
    EXPECT_FALSE(reference.is_reached());
    EXPECT_THROW(reference.reference(), std::bad_optional_access);
    for (const NestedSolution& solution : reference.solutions()) EXPECT_FALSE(solution.finished);
}

double smallest_volume_ratio(const pbs::Positions& positions)
{
    return pbs::tet_volumes(positions, bar.mesh.tets)
        .cwiseQuotient(pbs::tet_volumes(bar.mesh.rest, bar.mesh.tets))
        .minCoeff();
}

// A volume ratio is a quotient of sums of products of coordinates of at most 2 m, over that of a cell of 2 m / 12 by
// 1/4 m by 1/4 m.
constexpr double ratio_rounding = 1e-12;

// Linear elements may take four times the steps, which suffice for this pose. Reference: Newton's method alone from the
// same initial guess, which keeps its last iterate.
TEST(PosedReference, ThatDoesNotArriveReportsTheWorstTetOfItsLastNewtonState)
{
    const pbs::Pose pose = bent(40.0);
    DeformerSpec spec = hurried(2);
    const PosedReference reference(bar, spec, pose, time_step_s, ReferenceEffort::own_tets);
    const NestedSolution &quadratic = reference.solutions().front(), &linear = reference.solutions().back();
    ASSERT_FALSE(quadratic.finished);
    ASSERT_TRUE(linear.finished);

    options_of<FemOptions>(spec).nested_start = false;
    const auto alone = make_deformer(spec);
    alone->reset(bar);
    alone->start_from(linear.positions);
    ASSERT_EQ(alone->advance(pose, time_step_s).outcome, pbs::Outcome::not_converged);
    const double j_min = smallest_volume_ratio(alone->positions());
    EXPECT_NEAR(quadratic.j_min, j_min, ratio_rounding);
    EXPECT_GT(std::abs(linear.j_min - j_min), 1e-3);
    EXPECT_LT(j_min, 0.999);  // not the rest state
}

// Linear elements fail after four steps, so that quadratic ones are not tried.
TEST(PosedReference, ThatIsNotTriedReportsTheWorstTetOfTheCoarserSolution)
{
    const pbs::Pose pose = bent(40.0);
    const PosedReference reference(bar, hurried(1), pose, time_step_s, ReferenceEffort::own_tets);
    ASSERT_FALSE(reference.solutions().back().finished);

    const auto alone = make_deformer(hurried(4, 1));
    alone->reset(bar);
    ASSERT_EQ(alone->advance(pose, time_step_s).outcome, pbs::Outcome::not_converged);
    EXPECT_EQ(alone->positions(), bar.mesh.rest);
    const double j_min = smallest_volume_ratio(last_state(*alone));
    EXPECT_LT(j_min, 0.999);
    EXPECT_NEAR(reference.solutions().front().j_min, j_min, ratio_rounding);
    EXPECT_NEAR(reference.solutions().back().j_min, j_min, ratio_rounding);
}

}  // namespace
