// Reference: the conditions that rest is an equilibrium and that the moduli at small strains are those of Hooke's law.
#include "pbs/flesh/flesh_energy.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

class FleshMaterialOf : public testing::TestWithParam<double> {};

// The stress mu F + lambda (J - alpha) dJ/dF vanishes at F = I, where dJ/dF = I.
TEST_P(FleshMaterialOf, HasNoStressAtRest)
{
    const pbs::FleshMaterial material = pbs::flesh_material(GetParam());
    EXPECT_NEAR(material.mu + material.lambda * (1.0 - material.alpha), 0.0, test_support::rounding_error(8, material.lambda));
}

// Along F = (1 + e) I: psi'' = 3 mu + lambda ((3 J'') (J - alpha) + 9) at e = 0 with J = (1 + e)^3, so J' = 3, J'' = 6; it is 9 K.
TEST_P(FleshMaterialOf, HasTheBulkModulus)
{
    const double nu = GetParam();
    const pbs::FleshMaterial material = pbs::flesh_material(nu);
    const double bulk = 1.0 / (3.0 * (1.0 - 2.0 * nu));
    const double second = 3.0 * material.mu + material.lambda * (9.0 + 6.0 * (1.0 - material.alpha));
    EXPECT_NEAR(second, 9.0 * bulk, test_support::rounding_error(30, 9.0 * material.lambda) / (1.0 - 2.0 * nu));
}

// Along the shear F = I + e (1, 2): J = 1 and |F|^2 = 3 + e^2, so psi'' = mu, the shear modulus E / (2 (1 + nu)).
TEST_P(FleshMaterialOf, HasTheShearModulus)
{
    EXPECT_DOUBLE_EQ(pbs::flesh_material(GetParam()).mu, 0.5 / (1.0 + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, FleshMaterialOf, testing::Values(0.0, 0.3, 0.45, 0.499));

TEST(FleshMaterial, RefusesRatiosWithoutAFiniteModulus)
{
    EXPECT_THROW(pbs::flesh_material(0.5), pbs::InputError);
    EXPECT_THROW(pbs::flesh_material(-0.1), pbs::InputError);
    EXPECT_THROW(pbs::flesh_material(std::numeric_limits<double>::quiet_NaN()), pbs::InputError);
}

}  // namespace
