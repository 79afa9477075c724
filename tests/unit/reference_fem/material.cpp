// Reference: relations between elastic constants, by hand: E = mu (3 lambda + 2 mu) / (lambda + mu), nu = lambda / (2 (lambda + mu)).
#include "reference_fem/material.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using reference_fem::Lame;
using reference_fem::lame_parameters;

// Each relation goes through some fifteen roundings. 1 - 2 nu cancels in lambda, but E and nu depend on lambda by a factor below 1 - 2 nu
// where nu is close to 1/2. At nu = -0.4 the sums lambda + mu and 3 lambda + 2 mu cancel, by factors of 2.6 and 5.
TEST(Material, LameParametersReturnYoungsModulusAndPoissonsRatio)
{
    for (const double poisson : {-0.4, 0.0, 0.3, 0.45, 0.4999}) {
        const auto [lambda, mu] = lame_parameters(7e4, poisson);
        EXPECT_NEAR(mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), 7e4, test_support::rounding_error(15, 5.0 * 7e4));
        EXPECT_NEAR(lambda / (2.0 * (lambda + mu)), poisson, test_support::rounding_error(15, 2.6 * 0.5));
    }
}

TEST(Material, RefusesWhatNoStableMaterialHas)
{
    for (const double young : {0.0, -1.0, double(INFINITY), std::nan("")}) EXPECT_THROW(lame_parameters(young, 0.3), pbs::InputError);
    for (const double poisson : {-1.0, 0.5, 0.6, std::nan("")}) EXPECT_THROW(lame_parameters(1.0, poisson), pbs::InputError);
}

}  // namespace
