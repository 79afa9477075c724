// Reference: the theory of quadrature. Twice as many sample points of the springs in every direction are a finer midpoint rule, whose error
// falls to a quarter. The body is the bar of two bones, bent by 40 degrees, with stable neo-Hookean flesh.
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "pbs/character/bodies.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

pbs::Positions bent_bar(const std::array<int, 3>& cells, const FemOptions& options)
{
    const pbs::Character bar = test_support::bar_character(cells);
    ElasticFemDeformer fem(options);
    fem.reset(bar);
    const pbs::Pose pose = pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitZ(), 40.0, 2, 0.01).steps.back();
    EXPECT_EQ(fem.advance(pose, 0.01).outcome, pbs::Outcome::finished);
    EXPECT_EQ(fem.record()["newton"]["most_inverted_points"].get<int>(), 0);
    return fem.positions();
}

FemOptions smooth(int element_order)
{
    return {.model = reference_fem::Model::stable_neo_hookean, .element_order = element_order, .attachment = FemAttachment::smooth};
}

// Errors of order h^2 leave a quarter of the first difference: |x_2 - x_4| = (1/4 - 1/16) C, |x_1 - x_2| = (1 - 1/4) C.
// Points that fall into other tets add an error that is not smooth, so that the test requires a half instead of a quarter.
TEST(SmoothAttachment, MoreSamplePointsChangeLessAndLess)
{
    std::vector<pbs::Positions> shapes;
    for (const int samples : {1, 2, 4}) {
        FemOptions options = smooth(1);
        options.attachment_samples = samples;
        shapes.push_back(bent_bar({16, 4, 4}, options));
    }
    const double first = (shapes[1] - shapes[0]).norm(), second = (shapes[2] - shapes[1]).norm();
    const double motion = (shapes[2] - test_support::bar_character({16, 4, 4}).mesh.rest).norm();
    RecordProperty("first_change_over_motion", std::to_string(first / motion * 1e6) + "e-6");
    RecordProperty("second_change_over_motion", std::to_string(second / motion * 1e6) + "e-6");
    EXPECT_LT(second, 0.5 * first);
    EXPECT_LT(first, 1e-3 * motion);
}

}  // namespace
