// C03 and C12 are judged from the values that the convergence study writes: if the paths behind them are altered, the
// verdicts change.

#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/iteration_paths.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace {

using namespace experiments;
using namespace test_support;
using analysis::Measurement;
using analysis::VerdictKind;

// Sixteen poses of a body, of which the last `others` have other paths.
std::vector<ConvergencePaths> poses(const ConvergencePaths& first, int others, const ConvergencePaths& other)
{
    std::vector<ConvergencePaths> all;
    for (int i = 0; i < 16; ++i) {
        ConvergencePaths& one = all.emplace_back(i < 16 - others ? first : other);
        one.of.pose = one.key.pose = "pose " + std::to_string(i);
    }
    return all;
}

ConvergencePaths altered(ConvergencePaths paths, const std::function<void(ConvergencePaths&)>& alter)
{
    alter(paths);
    return paths;
}

struct JudgedPaths {
    const char *name, *claim;
    VerdictKind kind;
    ConvergencePaths first;
    int others = 0;
    ConvergencePaths other = {};
};

// Reference: the rules in experiments/verdicts/claims.toml. A rate r needs ceil(log 0.05 / log r) iterations: 14 for
// 0.8, 19 for 0.85, 24 for 0.88, 26 for 0.89, 59 for 0.95. A coin reaches 14 of 16 cases with a probability of 137 /
// 2^16, and 12 with 2517 / 2^16.
TEST(ConvergenceVerdict, FollowsFromThePaths)
{
    using enum VerdictKind;
    const ConvergencePaths lbs_is_best = papers_paths({0.8, 0.9, 0.95, 0.85}),
                           rigid_is_best = papers_paths({0.95, 0.9, 0.95, 0.85}),
                           all_alike = papers_paths({0.8, 0.8, 0.8, 0.8}),
                           neither = papers_paths({0.999, 0.5, 0.5, 0.999}),
                           in_24 = papers_paths({0.88, 0.9, 0.9, 0.9}), in_26 = papers_paths({0.89, 0.9, 0.9, 0.9});
    const auto of_another_order =
        altered(lbs_is_best, [](ConvergencePaths& of) { of.of.order = "ordered", of.of.precision = "f32"; });
    const auto random_is_quick = altered(lbs_is_best, [](ConvergencePaths& of) { of.controls[1] = of.paths[0]; });
    const auto second_is_slow = altered(lbs_is_best, [](ConvergencePaths& of) { of.controls[0] = of.paths[3]; });
    const auto without_controls = altered(lbs_is_best, [](ConvergencePaths& of) { of.controls.clear(); });
    const JudgedPaths cases[] = {
        {"the rigid bind takes longer", "C03", holds, lbs_is_best},
        {"in 14 of 16", "C03", mixed, lbs_is_best, 2, rigid_is_best},
        {"in 12 of 16, which a coin reaches", "C03", not_shown, lbs_is_best, 4, rigid_is_best},
        {"LBS takes longer", "C03", fails, rigid_is_best},
        {"no guess is better", "C03", fails, all_alike},
        {"where neither arrives there is no case", "C03", holds, lbs_is_best, 8, neither},
        {"random positions arrive as early", "C03", inconclusive, random_is_quick},
        {"LBS takes longer than LBS", "C03", inconclusive, second_is_slow},
        {"without controls", "C03", inconclusive, without_controls},
        {"another order", "C03", inconclusive, of_another_order},
        {"a twist", "C03", inconclusive, altered(lbs_is_best, [](ConvergencePaths& of) { of.twist = true; })},
        {"24 iterations", "C12a", holds, in_24},
        {"26 iterations in 2 of 16", "C12a", mixed, in_24, 2, in_26},
        {"26 iterations in 4 of 16, which a coin reaches", "C12a", not_shown, in_24, 4, in_26},
        {"26 iterations", "C12a", fails, in_26},
        {"more than 1000 iterations", "C12a", fails, neither},
        {"another order", "C12a", inconclusive, of_another_order},
        {"limbs", "C12a", inconclusive, altered(in_24, [](ConvergencePaths& of) { of.character = false; })}};
    for (const auto& [name, id, kind, first, others, other] : cases)
        EXPECT_EQ(verdict_on(id, values_of_paths(poses(first, others, other))), kind) << name;
}

// The author's later code takes 5 iterations to its own floor.
TEST(ConvergenceVerdict, ComparesTheAuthorsLaterCode)
{
    const auto of = altered(papers_paths({0.89, 0.9, 0.9, 0.9}),
                            [](ConvergencePaths& one) { one.author = path_to_floor(1000, 3.0, 3.0, 0.5); });
    const analysis::Verdict verdict = verdict_from("C12a", values_of_paths(poses(of, 0, {})));
    EXPECT_EQ(verdict.kind, VerdictKind::fails);
    const auto author = std::ranges::find(verdict.others, "the author's later code",
                                          [](const auto& one) { return one.selection.name; });
    ASSERT_NE(author, verdict.others.end());
    EXPECT_EQ(author->held, 16);
    EXPECT_EQ(author->n, 16);
}

// The limb's bend on four sizes, which need these iterations.
VerdictKind of_ladder(const std::array<int, 4>& iterations)
{
    std::vector<ConvergencePaths> ladder;
    for (std::size_t i = 0; i < iterations.size(); ++i) {
        ConvergencePaths& one = ladder.emplace_back(papers_paths({0.5}));
        one.of.vertices = 500 << i;
        one.key = {.motion = "bend", .angle_deg = 90.0};
        one.paths = {path_by(1000, [least = iterations[i]](int n) { return n < least ? 2.0 : 1.0; })};
    }
    return verdict_on("C12b", convergence_conclusions(values_of_paths(ladder, true)));
}

TEST(ConvergenceVerdict, FollowsFromTheExponentOfTheLadder)
{
    EXPECT_EQ(of_ladder({13, 20, 31, 46}), VerdictKind::holds);
    EXPECT_EQ(of_ladder({46, 31, 20, 13}), VerdictKind::fails);
    EXPECT_EQ(of_ladder({20, 20, 20, 20}), VerdictKind::fails);
    EXPECT_EQ(of_ladder({31, 13, 46, 20}), VerdictKind::mixed) << "sizes shuffled";
}

// A limb bent by 15 degrees, at which the correct solver restores the volume from every initial guess, iterated by the
// correct solver and by broken ones. Reference:
// - volume sign: every projection doubles the error that it should remove, so no initial guess comes within 0.5 % of
//   the volume, and the error after 1000 iterations is far above that of the correct solver.
// - volume dropped: nothing restores the volume, so no initial guess converges by volume, and 24 iterations do not
// suffice.
// - bind dropped: nothing moves the body towards the pose. The rest pose satisfies all remaining constraints, stays in
//   place and is converged at once, so LBS is not the better initial guess.
// - nothing projected: every initial guess stays unchanged, to the bit: the rest pose has its volume at once, LBS
// never.
// - stretch dropped: the bind and the volume constraints remain, and the last residual of the edges is larger.

const analysis::CaseKey by_volume = {.tolerance = "volume"};

const ConvergenceResult& bend(Broken how)
{
    static std::map<Broken, ConvergenceResult> kept;
    if (const auto found = kept.find(how); found != kept.end()) return found->second;
    ConvergenceCase of;
    of.scene = broken(read_scene("limb_bend", {"character.vertices=300"}), how);
    of.frames = {{3, "bend 15"}};
    of.k_stretch = {options_of<pbs::PbsOptions>(spec_of(of.scene, "pbs")).k_stretch};
    of.settings = {{pbs::Order::plain, pbs::Precision::f32}};
    return kept.emplace(how, measure_convergence(of)).first->second;
}

std::vector<Measurement> measured(Broken how)
{
    return values_of_paths(bend(how).all);
}

const IterationPath& path(Broken how, SolverStart start)
{
    return bend(how).all.front().paths[static_cast<int>(start)];
}

// To the volume's tolerance, by the bound of C12a.
bool twenty_four_suffice(Broken how)
{
    const Measurement iterations = values_of(measured(how), "iterations_to_tolerance_of_limbs", by_volume).at(0);
    return iterations.limit == analysis::Limit::none && claim("C12a").own.thresholds.at(0).contains(iterations.value);
}

// The initial guesses that are compared with LBS by volume: those of which one of the two arrives.
std::size_t guesses_with_arrival(Broken how)
{
    return values_of(measured(how), "iterations_over_lbs_guess", by_volume).size();
}

double from_rest_over_lbs_by_volume(Broken how)
{
    return values_of(measured(how), "iterations_over_lbs_guess", {.initial_guess = "rest_pose", .tolerance = "volume"})
        .at(0)
        .value;
}

TEST(BrokenConvergence, AsItIsEveryStartArrivesByVolume)
{
    EXPECT_EQ(guesses_with_arrival(Broken::nothing), 3u);
    EXPECT_TRUE(twenty_four_suffice(Broken::nothing));
    EXPECT_GT(from_rest_over_lbs_by_volume(Broken::nothing), 1.05);
}

TEST(BrokenConvergence, TheSignTurnedRoundOrWithoutVolumeNoStartArrivesByVolume)
{
    for (const Broken how : {Broken::volume_sign, Broken::volume_dropped}) {
        EXPECT_EQ(guesses_with_arrival(how), 0u) << name_of(how);
        EXPECT_FALSE(twenty_four_suffice(how)) << name_of(how);
    }
    const double sound = floor_of(bend(Broken::nothing).all.front().paths),
                 turned = floor_of(bend(Broken::volume_sign).all.front().paths);
    EXPECT_FALSE(turned <= 10.0 * sound) << turned << " " << sound;  // not a number if nothing stayed finite
}

// The rounding of strains in float: a coordinate of 1.15 m is rounded once, which is relative to the shortest edge, at
// both of its ends; a strain goes through eight more roundings.
double strain_error()
{
    const pbs::TetMesh mesh = pbs::make_character({.body = "limb", .vertices = 300}).mesh;
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    double shortest_m = 1.0;
    for (const auto& edge : edges.rowwise())
        shortest_m = std::min(shortest_m, (mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm());
    return rounding_error_in<float>(2.0 * std::sqrt(3.0) * 1.15 / shortest_m + 8.0, 1.0);
}

TEST(BrokenConvergence, WithoutBindTheRestPoseStaysAndIsThereAtOnce)
{
    const IterationPath& rest = path(Broken::bind_dropped, SolverStart::rest_pose);
    EXPECT_LT(rest.looks.back().stretch_rms, strain_error());
    // It has not come any closer; with bind constraints less than a tenth remains.
    EXPECT_GT(rest.looks.back().bind_rms_m, 0.99 * rest.looks.front().bind_rms_m);
    EXPECT_LT(path(Broken::nothing, SolverStart::rest_pose).looks.back().bind_rms_m,
              0.1 * rest.looks.front().bind_rms_m);
    EXPECT_LE(from_rest_over_lbs_by_volume(Broken::bind_dropped), 1.0);
}

TEST(BrokenConvergence, WithoutStretchEdgesAreFartherFromTheirLengths)
{
    for (const SolverStart start : all_starts)
        EXPECT_GT(path(Broken::stretch_dropped, start).looks.back().stretch_rms,
                  path(Broken::nothing, start).looks.back().stretch_rms)
            << name_of(start);
}

TEST(BrokenConvergence, WithNothingProjectedEveryStartStays)
{
    for (const SolverStart start : all_starts) {
        const auto& looks = path(Broken::nothing_projected, start).looks;
        // The initial guess itself is in double. Volumes are in error by three times as much as lengths, and relative
        // distances by less.
        EXPECT_NEAR(looks.at(1).combined, looks.front().combined, 3.0 * strain_error() * (1.0 + looks.front().combined))
            << name_of(start);
        EXPECT_EQ(looks.back().combined, looks.at(1).combined) << name_of(start);
    }
    EXPECT_LE(from_rest_over_lbs_by_volume(Broken::nothing_projected), 1.0);
    EXPECT_FALSE(twenty_four_suffice(Broken::nothing_projected));
}

}  // namespace
