// Reference: dimensional analysis. With displacement data, free surfaces and no body force, every force is proportional to Young's modulus
// (also those of the attachment's springs, whose density is q E / r^2). The positions therefore do not depend on it, and twist and bend can
// only determine nu. Multiplied by an even power of two, Young's modulus changes no digit of a force, of a root in Cholesky's factorisation
// or of a quotient of forces, and Newton's stopping criterion is relative to the forces: the positions are equal to the bit.
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using pbs::Positions;
using reference_fem::Model;

const pbs::Character& bar()
{
    static const pbs::Character character = test_support::bar_character({12, 3, 3});
    return character;
}

// The positions with the joint twisted and bent at once.
Positions turned(FemOptions options, double young_pa, double angle_deg)
{
    options.young_pa = young_pa;
    std::unique_ptr<Deformer> fem;
    if (options.model == Model::linear)
        fem = std::make_unique<LinearFemDeformer>(options);
    else
        fem = std::make_unique<ElasticFemDeformer>(options);
    fem->reset(bar());
    const auto pose = pbs::joint_sweep(bar().skeleton, 1, pbs::Vec3(1, 0, 1).normalized(), angle_deg, 2, 0.01).steps.back();
    EXPECT_EQ(fem->advance(pose, 0.01).outcome, pbs::Outcome::finished);
    return fem->positions();
}

double largest_distance(const Positions& a, const Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

class YoungCancels : public testing::TestWithParam<std::tuple<Model, int, FemAttachment>> {
protected:
    const double angle_deg = std::get<0>(GetParam()) == Model::linear ? 5.0 : 40.0;
    FemOptions options{.model = std::get<0>(GetParam()),
                       .element_order = std::get<1>(GetParam()),
                       .attachment = std::get<2>(GetParam()),
                       .core_radius = 1.0};
};

TEST_P(YoungCancels, WhereTheSkeletonIsAllThatActs)
{
    EXPECT_EQ(largest_distance(turned(options, 1e3, angle_deg), turned(options, 0x1p14 * 1e3, angle_deg)), 0.0);
}

TEST_P(YoungCancels, ButNotWhereAForceActs)
{
    options.gravity_m_s2 = pbs::Vec3(0, 0, -1);
    EXPECT_GT(largest_distance(turned(options, 1e5, angle_deg), turned(options, 1e7, angle_deg)), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Laws, YoungCancels,
                         testing::Combine(testing::Values(Model::linear, Model::stable_neo_hookean), testing::Values(1, 2),
                                          testing::Values(FemAttachment::embedded, FemAttachment::nodes)));

TEST(YoungCancelsSprings, OnlyBecauseTheirDensityGoesWithIt)
{
    FemOptions stiff{.model = Model::linear, .element_order = 1, .core_radius = 1.0, .spring_factor = 1e4};
    FemOptions same_springs = stiff;
    same_springs.spring_factor = stiff.spring_factor * 1e3 / 1e7;
    EXPECT_GT(largest_distance(turned(stiff, 1e3, 5.0), turned(same_springs, 1e7, 5.0)), 1e-5);
}

}  // namespace
