// C03 and C12 from the values that the convergence study writes, with the correct solver and with broken ones.

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
#include <map>

namespace {

using namespace experiments;
using namespace test_support;
using analysis::Measurement;

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
