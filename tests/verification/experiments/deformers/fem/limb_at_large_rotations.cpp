// The limb twisted to 180 and bent to 110 degrees in steps of 30 to 45 degrees, stable neo-Hookean on linear tets, from compressible to
// nearly incompressible. Reference: Newton's method ends at the same equilibrium from either side. The volume that a law loses falls as its
// bulk modulus rises, to first order with 1 - 2 nu, so from nu 0.45 to 0.49 to a fifth. The test requires half of that fall, since at these
// angles and on linear tets the strain is not small.
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "pbs/character/bodies.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

const pbs::Character& limb()
{
    static const pbs::Character character = pbs::make_character({.body = "limb"});
    return character;
}

// The largest loss of volume over the frames, in per cent; each frame must converge.
double volume_loss_pct(double poisson, const pbs::Vec3& axis, double angle_deg, int frames)
{
    ElasticFemDeformer fem({.model = reference_fem::Model::stable_neo_hookean, .element_order = 1, .poisson = poisson});
    fem.reset(limb());
    for (const pbs::Pose& pose : pbs::joint_sweep(limb().skeleton, 1, axis, angle_deg, frames, 0.01).steps)
        EXPECT_EQ(fem.advance(pose, 0.01).outcome, pbs::Outcome::finished) << "nu " << poisson;
    return -fem.record()["newton"]["volume_change_pct"]["lowest"].get<double>();
}

TEST(LimbAtLargeRotations, TwistsTo180Degrees)
{
    const double compressible = volume_loss_pct(0.3, pbs::Vec3::UnitX(), 180.0, 5);
    const double flesh = volume_loss_pct(0.45, pbs::Vec3::UnitX(), 180.0, 5);
    const double nearly_incompressible = volume_loss_pct(0.49, pbs::Vec3::UnitX(), 180.0, 5);
    EXPECT_LT(flesh, compressible);
    EXPECT_LT(nearly_incompressible, flesh / 2.5);
}

TEST(LimbAtLargeRotations, BendsTo110Degrees)
{
    const double compressible = volume_loss_pct(0.3, pbs::Vec3::UnitZ(), 110.0, 5);
    const double nearly_incompressible = volume_loss_pct(0.49, pbs::Vec3::UnitZ(), 110.0, 5);
    EXPECT_LT(nearly_incompressible, compressible / 2.5);
}

}  // namespace
