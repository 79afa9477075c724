// Sleep on the human through a jump: the difference from the full solve stays small. Reference: the same deformer without sleep.
#include "experiments/scene/scene.hpp"
#include "experiments/studies/timing/timing.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/options.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>

namespace {

using namespace experiments;

const std::vector<std::string> jump = {"motion.start_s=1.5", "motion.duration_s=0.05"};

std::optional<Scene> human(const Variant& variant)
{
    try {
        return scene_of("human_01_01", jump, variant);
    } catch (const pbs::InputError&) {
        return std::nullopt;
    }
}

double mean_edge_m(const pbs::TetMesh& mesh)
{
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    double sum = 0.0;
    for (Eigen::Index e = 0; e < edges.rows(); ++e) sum += (mesh.rest.row(edges(e, 0)) - mesh.rest.row(edges(e, 1))).norm();
    return sum / static_cast<double>(edges.rows());
}

// A sleeping constraint is violated by at most the tolerance at the end of the frame. In each of the 24 iterations it would have moved a
// vertex by no more than that, in the worst case always in one direction.
TEST(SleepOnTheHuman, ChangesThePoseByLessThanItsTolerance)
{
    const auto awake = human({}), asleep = human({.overrides = {"pbs.sleep=true"}});
    if (!awake || !asleep) GTEST_SKIP() << "assimp-testmodels is not installed";
    const ResultChange change = change_between(*awake, *asleep);
    const double edge_m = mean_edge_m(pbs::make_character(awake->character).mesh);
    const pbs::PbsOptions& options = experiments::options_of<pbs::PbsOptions>(asleep->deformers.front());
    std::printf("largest change %.3g m, %.3g mean edges\n", change.distance_m, change.distance_m / edge_m);
    EXPECT_LT(change.distance_m, options.iterations * options.sleep_tolerance * edge_m);
    EXPECT_LT(change.volume_difference_pct, 0.05);  // a tenth of the bound of the claim
}

}  // namespace
