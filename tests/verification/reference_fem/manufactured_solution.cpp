// Reference: a manufactured solution u_i = sin(a_i . x + phi_i), whose body force follows by hand. Theory (Brenner and Scott, The
// mathematical theory of finite element methods, ch. 5): order p elements converge with h^(p+1) in L2 and h^p in the H1 seminorm.
// Tolerance: the observed order between the two finest of three meshes lies within 0.1 of it; on jittered meshes the error constants of two
// meshes differ by a few percent, 0.05 in the order.
#include "reference_fem/boundary_value_problem.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Vec3;

const ElasticMaterial material{1.0, 0.3};

Eigen::Matrix3d wave_vectors()
{
    Eigen::Matrix3d a;
    a << 1.7, 0.9, -0.6, -0.8, 1.4, 1.1, 0.5, -1.2, 1.6;
    return a;
}
const Eigen::Matrix3d a = wave_vectors();  // row i: a_i
const Vec3 phase(0.3, 1.1, -0.4);

Vec3 exact(const Vec3& x)
{
    return (a * x + phase).array().sin();
}
Eigen::Matrix3d exact_gradient(const Vec3& x)
{
    return ((a * x + phase).array().cos().matrix()).asDiagonal() * a;
}

// f = -(lambda + mu) grad(div u) - mu laplace(u).
Vec3 body_force(const Vec3& x)
{
    const double lambda = 15.0 / 26.0, mu = 5.0 / 13.0;  // E = 1, nu = 0.3, by hand
    const Vec3 sine = exact(x);
    const Vec3 gradient_of_divergence = -a.transpose() * a.diagonal().cwiseProduct(sine);
    const Vec3 laplacian = -a.rowwise().squaredNorm().cwiseProduct(sine);
    return -(lambda + mu) * gradient_of_divergence - mu * laplacian;
}

struct Orders {
    double l2, h1;
};

Orders observed_orders(int element_order, int coarse)
{
    ErrorNorms errors[2];
    for (int level = 0; level < 2; ++level)
        errors[level] = solve(test_support::jittered_cube(coarse << level), material, {body_force, exact, {}, element_order})
                            .errors(exact, exact_gradient);
    return {std::log2(errors[0].l2 / errors[1].l2), std::log2(errors[0].h1_seminorm / errors[1].h1_seminorm)};
}

TEST(ManufacturedSolution, LinearTetsConvergeWithOrdersTwoAndOne)
{
    const Orders orders = observed_orders(1, 8);
    RecordProperty("l2_order", std::to_string(orders.l2));
    RecordProperty("h1_order", std::to_string(orders.h1));
    EXPECT_NEAR(orders.l2, 2.0, 0.1);
    EXPECT_NEAR(orders.h1, 1.0, 0.1);
}

TEST(ManufacturedSolution, QuadraticTetsConvergeWithOrdersThreeAndTwo)
{
    const Orders orders = observed_orders(2, 4);
    RecordProperty("l2_order", std::to_string(orders.l2));
    RecordProperty("h1_order", std::to_string(orders.h1));
    EXPECT_NEAR(orders.l2, 3.0, 0.1);
    EXPECT_NEAR(orders.h1, 2.0, 0.1);
}

}  // namespace
