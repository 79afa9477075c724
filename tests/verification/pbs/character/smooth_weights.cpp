// Smooth weights on the real body, as a control of Eq. 2. Reference: the definition of weights (they are not negative and sum up to one)
// and the tets' own orientation. In the crouch of clip 01_01 LBS with Eq. 2's weights, which jump between vertices, turns tets inside out.
// Needs Debian's assimp-testmodels, which set-up installs.
#include "pbs/character/bodies.hpp"
#include "pbs/character/clip.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/weight_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace pbs;

const Character& human_of_blends()
{
    static const Character character = make_character({.body = "human"});
    return character;
}

const Pose& crouch()
{
    static const Motion motion = [] {
        ClipSampling sampling;
        sampling.time_step_s = 0.01;
        sampling.rate_hz = 100.0;
        return retarget(read_clip(find_clip("01_01.bvh", ".")), human_of_blends().skeleton, sampling);
    }();
    return motion.steps.at(164);
}

template <class Blend>
int inverted_tets(WeightKind kind, const Blend& blend)
{
    const Character& human = human_of_blends();
    Positions posed;
    blend(human.mesh.rest, weights_by(kind, human), crouch(), posed);
    return static_cast<int>((tet_volumes(posed, human.mesh.tets).array() <= 0.0).count());
}

TEST(SmoothWeightsOfTheHuman, SumUpToOneAndAreNotNegative)
{
    const Weights weights = weights_by(WeightKind::diffused, human_of_blends());
    ASSERT_EQ(weights.vertices(), human_of_blends().mesh.rest.rows());
    int blended = 0;
    for (const double weight : weights.weight) EXPECT_GE(weight, 0.0);
    for (int v = 0; v < weights.vertices(); ++v) {
        EXPECT_NEAR(test_support::sum_of_weights(weights, v), 1.0, test_support::mean_error(weights.first[v + 1] - weights.first[v], 1.0));
        blended += weights.blended(v);
    }
    EXPECT_GT(blended, weights.vertices() / 10);
}

// Both blends have the same pose and the same mesh, and the counts are whole numbers: no tolerance. The blends with smooth weights leave at
// most a tenth of the inverted tets.
TEST(SmoothWeightsOfTheHuman, LeaveFewerTetsInverted)
{
    const int paper = inverted_tets(WeightKind::paper, linear_blend_skinning),
              smooth = inverted_tets(WeightKind::diffused, linear_blend_skinning);
    RecordProperty("inverted_by_lbs_with_paper_weights", paper);
    RecordProperty("inverted_by_lbs_with_smooth_weights", smooth);
    EXPECT_GT(paper, 50);
    EXPECT_LT(10 * smooth, paper);
    EXPECT_LT(inverted_tets(WeightKind::diffused, dual_quaternion_skinning), inverted_tets(WeightKind::paper, dual_quaternion_skinning));
}

}  // namespace
