// Reference: a manufactured solution of stable neo-Hookean flesh that is held by smooth springs
// (experiments/studies/verification/attachment_problems.hpp). The verification record's problem nested_convergence shows the order and
// the bound of nested solutions on it.
#include "experiments/studies/verification/attachment_problems.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

double error_of(const pbs::TetMesh& mesh, int element_order, const ManufacturedSprings& springs = {})
{
    const AttachedSolution solution = solve_manufactured(mesh, element_order, springs);
    EXPECT_TRUE(solution.converged);
    return solution.error;
}

// Errors C h^p (1 + c h) show an order that differs from p by c h / (2 ln 2), half as much on meshes twice as fine. The order of the finest
// two is therefore within 0.1 (jittered meshes: their constants differ by a few per cent) or closer than that of the coarser two by
// nearly a half.
void expect_order(int element_order, int coarsest)
{
    const double order = element_order + 1;
    pbs::TetMesh mesh = test_support::jittered_cube(coarsest);
    std::vector<double> errors;
    for (int level = 0; level < 3; ++level) {
        errors.insert(errors.begin(), error_of(mesh, element_order));
        mesh = pbs::refine(mesh).mesh;
    }
    const double coarser = std::abs(std::log2(errors[2] / errors[1]) - order), finer = std::abs(std::log2(errors[1] / errors[0]) - order);
    testing::Test::RecordProperty("order_differs_by", std::to_string(finer));
    EXPECT_LT(finer, std::max(0.1, 0.6 * coarser));
}

TEST(ManufacturedAttachment, LinearTetsConvergeWithOrderTwo)
{
    expect_order(1, 4);
}

TEST(ManufacturedAttachment, QuadraticTetsConvergeWithOrderThree)
{
    expect_order(2, 2);
}

// Springs of twice or half the weight pull with another force than the body force balances. Where they are stiff, the flesh then moves by
// the offset times 1 / 2 or 1; right ones leave only the error of the elements and of the sample points.
TEST(ManufacturedAttachment, SpringsOfAnotherWeightLeaveAnotherForce)
{
    const pbs::Vec3 large_offset(0.02, -0.01, 0.03);
    const pbs::TetMesh mesh = test_support::jittered_cube(8);
    const double right = error_of(mesh, 1, {large_offset});
    for (const double weight : {0.5, 2.0}) EXPECT_GT(error_of(mesh, 1, {large_offset, weight}), 3.0 * right) << weight;
}

}  // namespace
