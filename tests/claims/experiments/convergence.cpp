// C03 and C12 are judged from the values that the convergence study writes: if the paths behind them are altered, the verdicts change.

#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/iteration_paths.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace {

using namespace experiments;
using namespace test_support;
using analysis::Measurement;
using analysis::VerdictKind;

// The volume converges after one iteration from LBS and after two from all other initial guesses, so only the residual decides.
ConvergencePaths by_residual(const std::vector<double>& rates)
{
    ConvergencePaths paths = starts_at_rates(1780, rates);
    for (std::size_t start = 0; start < paths.paths.size(); ++start)
        for (auto& look : paths.paths[start].looks) look.volume_abs_change_pct = look.iteration < (start ? 2 : 1) ? 1.0 : 0.0;
    return paths;
}

ConvergencePaths altered(ConvergencePaths paths, const std::function<void(ConvergencePaths&)>& alter)
{
    alter(paths);
    return paths;
}

struct JudgedPaths {
    const char *name, *claim;
    std::vector<ConvergencePaths> paths;
    VerdictKind kind;
};

// Reference: the rules in experiments/verdicts/claims.toml. A rate r needs ceil(log 0.05 / log r) iterations: 24 for 0.88, 26 for 0.89.
TEST(ConvergenceVerdict, FollowsFromThePaths)
{
    using enum VerdictKind;
    const ConvergencePaths lbs_is_best = by_residual({0.8, 0.9, 0.95, 0.85}), in_24 = by_residual({0.88, 0.9, 0.9, 0.9}),
                           in_26 = by_residual({0.89, 0.9, 0.9, 0.9});
    const auto never_by_volume = [](ConvergencePaths& of) {
        for (auto& path : of.paths)
            for (auto& look : path.looks) look.volume_abs_change_pct = 1.0;
    };
    const auto late_from_lbs = [](ConvergencePaths& of) { of.paths[0] = path_by(1000, [](int n) { return n < 500 ? 2.0 : 1.0; }); };
    const auto never_from_lbs = [](ConvergencePaths& of) {
        for (auto& look : of.paths[0].looks) look.volume_abs_change_pct = 0.51;
    };
    const JudgedPaths cases[] = {
        {"every other initial guess takes longer", "C03", {lbs_is_best}, reproduced},
        {"one of them arrives earlier", "C03", {by_residual({0.8, 0.7, 0.95, 0.85})}, reproduced_only_for},
        {"one of them arrives earlier in another order", "C03", {lbs_is_best, by_residual({0.92, 0.9, 0.95, 0.85})}, reproduced_only_for},
        {"LBS is the slowest", "C03", {altered(by_residual({0.95, 0.8, 0.8, 0.8}), late_from_lbs)}, not_reproduced},
        {"neither arrives in another order", "C03", {lbs_is_best, altered(lbs_is_best, never_by_volume)}, reproduced_only_for},
        {"twists are not judged", "C03", {altered(lbs_is_best, [](ConvergencePaths& of) { of.twist = true; })}, not_computable},
        {"limbs are not judged", "C12", {altered(in_26, [](ConvergencePaths& of) { of.character = false; })}, not_computable},
        {"24 iterations", "C12", {in_24}, reproduced},
        {"26 iterations by residual, one by volume", "C12", {in_26}, reproduced_only_for},
        {"26 iterations in another order", "C12", {in_24, in_26}, reproduced_only_for},
        {"neither tolerance is reached", "C12", {altered(by_residual({0.999, 0.5, 0.5, 0.5}), never_from_lbs)}, not_reproduced}};
    for (const auto& [name, id, paths, kind] : cases) EXPECT_EQ(verdict_on(id, convergence_values({paths, false, ""})), kind) << name;
}

// C03 and C12 from a limb bent by 15 degrees, at which the correct solver restores the volume from every initial guess, iterated by the
// correct solver and by broken ones. Reference:
// - volume sign: every projection doubles the error that it should remove, so no initial guess comes within 0.5 % of the volume, and the
//   error after 1000 iterations is far above that of the correct solver.
// - volume dropped: nothing restores the volume, so no initial guess converges by volume, and 24 iterations do not suffice. C03 has no
//   value by volume and is judged by the residual alone.
// - bind dropped: nothing moves the body towards the pose. The rest pose satisfies all remaining constraints, stays in place and is
//   converged at once, so LBS is not the better initial guess.
// - nothing projected: every initial guess stays unchanged, to the bit: the rest pose has its volume at once, LBS never.
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
    return convergence_values(bend(how));
}

const IterationPath& path(Broken how, SolverStart start)
{
    return bend(how).all.front().paths[static_cast<int>(start)];
}

VerdictKind verdict_of_c03(Broken how)
{
    return verdict_on("C03", measured(how));
}

// The limb is reported with C12; here it is judged like the value of a character.
analysis::Extent twenty_four_suffice(Broken how)
{
    Measurement measurement = values_of(measured(how), "iterations_to_tolerance_of_limbs", by_volume).at(0);
    measurement.quantity = "iterations_to_tolerance";
    return analysis::extent_of(claim("C12"), measurement);
}

double share_without_arrival(Broken how)
{
    return values_of(measured(how), "share_of_ratios_not_reached", by_volume).at(0).value;
}

double from_rest_over_lbs_by_volume(Broken how)
{
    return values_of(measured(how), "iterations_over_lbs_guess", {.initial_guess = "rest_pose", .tolerance = "volume"}).at(0).value;
}

TEST(BrokenConvergence, AsItIsEveryStartArrivesByVolume)
{
    EXPECT_EQ(share_without_arrival(Broken::nothing), 0.0);
    EXPECT_EQ(twenty_four_suffice(Broken::nothing), analysis::Extent::whole);
    EXPECT_GT(from_rest_over_lbs_by_volume(Broken::nothing), 1.05);
    EXPECT_EQ(verdict_of_c03(Broken::nothing), VerdictKind::reproduced);
}

TEST(BrokenConvergence, TheSignTurnedRoundOrWithoutVolumeNoStartArrivesByVolume)
{
    for (const Broken how : {Broken::volume_sign, Broken::volume_dropped}) {
        EXPECT_EQ(share_without_arrival(how), 1.0) << name_of(how);
        EXPECT_EQ(twenty_four_suffice(how), analysis::Extent::none) << name_of(how);
    }
    EXPECT_NE(verdict_of_c03(Broken::volume_sign), VerdictKind::reproduced);
    const double sound = floor_of(bend(Broken::nothing).all.front().paths), turned = floor_of(bend(Broken::volume_sign).all.front().paths);
    EXPECT_FALSE(turned <= 10.0 * sound) << turned << " " << sound;  // not a number if nothing stayed finite
    EXPECT_TRUE(values_of(measured(Broken::volume_dropped), "iterations_over_lbs_guess", by_volume).empty());
    EXPECT_FALSE(values_of(measured(Broken::nothing), "iterations_over_lbs_guess", by_volume).empty());
}

// The rounding of strains in float: a coordinate of 1.15 m is rounded once, which is relative to the shortest edge, at both of its ends; a
// strain goes through eight more roundings.
double strain_error()
{
    const pbs::TetMesh mesh = pbs::make_character({.body = "limb", .vertices = 300}).mesh;
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    double shortest_m = 1.0;
    for (const auto& edge : edges.rowwise()) shortest_m = std::min(shortest_m, (mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm());
    return rounding_error_in<float>(2.0 * std::sqrt(3.0) * 1.15 / shortest_m + 8.0, 1.0);
}

TEST(BrokenConvergence, WithoutBindTheRestPoseStaysAndIsThereAtOnce)
{
    const IterationPath& rest = path(Broken::bind_dropped, SolverStart::rest_pose);
    EXPECT_LT(rest.looks.back().stretch_rms, strain_error());
    // It has not come any closer; with bind constraints less than a tenth remains.
    EXPECT_GT(rest.looks.back().bind_rms_m, 0.99 * rest.looks.front().bind_rms_m);
    EXPECT_LT(path(Broken::nothing, SolverStart::rest_pose).looks.back().bind_rms_m, 0.1 * rest.looks.front().bind_rms_m);
    EXPECT_LE(from_rest_over_lbs_by_volume(Broken::bind_dropped), 1.0);
    EXPECT_NE(verdict_of_c03(Broken::bind_dropped), VerdictKind::reproduced);
}

TEST(BrokenConvergence, WithoutStretchEdgesAreFartherFromTheirLengths)
{
    for (const SolverStart start : all_starts)
        EXPECT_GT(path(Broken::stretch_dropped, start).looks.back().stretch_rms, path(Broken::nothing, start).looks.back().stretch_rms)
            << name_of(start);
}

TEST(BrokenConvergence, WithNothingProjectedEveryStartStays)
{
    for (const SolverStart start : all_starts) {
        const auto& looks = path(Broken::nothing_projected, start).looks;
        // The initial guess itself is in double. Volumes are in error by three times as much as lengths, and relative distances by less.
        EXPECT_NEAR(looks.at(1).combined, looks.front().combined, 3.0 * strain_error() * (1.0 + looks.front().combined)) << name_of(start);
        EXPECT_EQ(looks.back().combined, looks.at(1).combined) << name_of(start);
    }
    EXPECT_LE(from_rest_over_lbs_by_volume(Broken::nothing_projected), 1.0);
    EXPECT_EQ(twenty_four_suffice(Broken::nothing_projected), analysis::Extent::none);
    EXPECT_NE(verdict_of_c03(Broken::nothing_projected), VerdictKind::reproduced);
}

}  // namespace
