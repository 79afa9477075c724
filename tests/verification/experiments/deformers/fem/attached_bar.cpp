// Reference: rigid motion and objectivity, which are exact for a linear law since the root's motion is removed; the
// limit of stiff springs; a second solver. The body is the bar of two bones, with both attachments and both element
// orders.

#include "experiments/studies/verification/problem.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/fem_bar.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/newton_rounding.hpp"
#include "tests/support/structured_bar.hpp"

namespace {

using namespace experiments;
using namespace test_support;
using pbs::Positions;
using pbs::Vec3;

// The second one is for what holds on any mesh.
const pbs::Character bar = bar_character({32, 6, 6}), coarse_bar = bar_character({12, 3, 3});

// How far rounding moves the vertices of the coarse bar.
struct AttachedRounding {
    SolveRounding solve;
    int nodes = 0;

    // Targets in error by d: with springs of stiffness k, u K u <= sum k d^2, the energy of u = 0, and sum k <= |K|
    // nodes, since it is the energy of a unit translation. Prescribed nodes in error by d have the same bound. Hence
    // |u| <= sqrt(cond(K) nodes) d.
    double of_targets_m(double d) const { return std::sqrt(solve.spectrum.condition() * nodes) * d; }
};

// In a pose whose root is not moved.
AttachedRounding attached_rounding(const FemOptions& options, const pbs::Pose& pose)
{
    const pbs::TetMesh& mesh = coarse_bar.mesh;
    const BoneAttachment bones = bone_attachment(coarse_bar, options);
    const reference_fem::LinearOptions linear = linear_options(options);
    reference_fem::LinearElasticity elasticity(mesh, linear, bones.attachment);
    const reference_fem::Targets held = targets(bones, mesh.rest, pose);
    EXPECT_TRUE(elasticity.solve(held.springs, held.vertices).finite);
    return {rounding_of(elasticity, mesh, linear, bones.attachment), elasticity.setup().dofs / 3};
}

class AttachedBar : public testing::TestWithParam<std::tuple<FemAttachment, int>> {
protected:
    FemOptions options{.element_order = std::get<1>(GetParam()),
                       .attachment = std::get<0>(GetParam()),
                       .core_radius = 1.0,
                       .spring_factor = 1e4};
};

// The targets are at rest except for the rounding of positions in the frame of the root.
TEST_P(AttachedBar, FollowsARigidMotionOfAllBones)
{
    const pbs::Pose rest(2, Eigen::Isometry3d::Identity());
    const Positions expected = moved(coarse_bar.mesh.rest);
    const double of_frame_m = frame_rounding_m(expected);
    const double error_m = attached_rounding(options, rest).of_targets_m(of_frame_m) + of_frame_m;
    EXPECT_LT(largest_distance(deformed(coarse_bar, options, {moved(rest)}), expected), error_m);
    EXPECT_LT(error_m, 1e-7) << "a bound that would let another motion of the bar of 2 m pass proves nothing";
}

// If the whole pose and gravity are rotated, the solution rotates with them. Tolerance: the errors of two solves, and
// those of the targets in the frame of the root.
TEST_P(AttachedBar, IsObjective)
{
    FemOptions along = options;
    options.gravity_m_s2 = Vec3(0, -9.81, 1.0);
    along.gravity_m_s2 = rigid_motion.linear() * options.gravity_m_s2;
    const Positions expected = moved(deformed(coarse_bar, options, {turned(10.0)}));
    const AttachedRounding rounding = attached_rounding(options, turned(10.0));
    const double of_frame_m = frame_rounding_m(expected);
    const double error_m = 2.0 * rounding.solve.error_m() + rounding.of_targets_m(of_frame_m) + of_frame_m;
    EXPECT_LT(largest_distance(deformed(coarse_bar, along, {moved(turned(10.0))}), expected), error_m);
    EXPECT_LT(error_m, 1e-5) << "a bound that would let another shape of the bar of 2 m pass proves nothing";
}

TEST_P(AttachedBar, UmfpackGivesTheSame)
{
    const Positions cholmod = deformed(coarse_bar, options, {turned(10.0)});
    const double error_m = 2.0 * attached_rounding(options, turned(10.0)).solve.error_m();
    options.solver = reference_fem::LinearSolver::umfpack;
    EXPECT_LT(largest_distance(deformed(coarse_bar, options, {turned(10.0)}), cholmod), error_m);
    EXPECT_LT(error_m, 1e-5) << "a bound that would let another shape of the bar of 2 m pass proves nothing";
}

// A rotation of the joint by a small angle must be reproduced far from the joint. Where the bone's middle is held, the
// flesh follows it except for the fictitious strain 1 - cos(theta) = 1.5e-4 at 1 degree, over the width.
TEST_P(AttachedBar, FollowsASmallRotationWhereTheBoneHoldsIt)
{
    options.core_radius = 0.7;
    const pbs::Pose pose = turned(1.0);
    const Positions bar_deformed = deformed(bar, options, {pose});
    for (Eigen::Index v = 0; v < bar_deformed.rows(); ++v) {
        const Vec3 rest = bar.mesh.rest.row(v);
        if (rest(0) < 0.4 || rest(0) > 0.7) continue;
        EXPECT_LT((bar_deformed.row(v).transpose() - pose[1] * rest).norm(), 1.5e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(Attachments, AttachedBar,
                         testing::Combine(testing::Values(FemAttachment::embedded, FemAttachment::nodes),
                                          testing::Values(1, 2)));

// Doubling q from 1e4, with the joint bent by 10 degrees, for which a linear reference is still useful. Stated bounds:
// the root mean square change, which error_l2_pct reports, is below 0.01 % of the diagonal, a tenth of the bound of a
// claim; that of a single vertex is below 0.05 %. (A vertex that the springs reach only through a small shape function
// is held softly and still moves.)
TEST(EmbeddedBar, DoublingTheSpringsChangesNothingThatIsReported)
{
    const double diagonal = (bar.mesh.rest.colwise().maxCoeff() - bar.mesh.rest.colwise().minCoeff()).norm();
    for (const int order : {1, 2}) {
        FemOptions options{.element_order = order, .spring_factor = 1e4};
        const Positions once = deformed(bar, options, {turned(10.0)});
        options.spring_factor *= 2.0;
        const Positions change = deformed(bar, options, {turned(10.0)}) - once;
        const double rms = std::sqrt(change.squaredNorm() / static_cast<double>(change.rows())) / diagonal;
        const double largest = change.rowwise().norm().maxCoeff() / diagonal;
        RecordProperty("rms_change_over_diagonal", std::to_string(rms * 1e6) + "e-6");
        RecordProperty("largest_change_over_diagonal", std::to_string(largest * 1e6) + "e-6");
        EXPECT_LT(rms, 1e-4);
        EXPECT_LT(largest, 5e-4);
    }
}

// Reference: a manufactured solution of stable neo-Hookean flesh that is held by smooth springs
// (experiments/studies/verification/problem.hpp). The verification record's problem nested_convergence shows the order
// and the bound of nested solutions on it.

double error_of(const pbs::TetMesh& mesh, int element_order, const ManufacturedSprings& springs = {})
{
    const AttachedSolution solution = solve_manufactured(mesh, element_order, springs);
    EXPECT_TRUE(solution.converged);
    return solution.error;
}

class ManufacturedAttachment : public testing::TestWithParam<std::pair<int, int>> {};

// On three meshes, from so many cells a side on. Errors C h^p (1 + c h) show an order that differs from p by c h / (2
// ln 2), half as much on meshes twice as fine. The order of the finest two is therefore within 0.1 (jittered meshes:
// their constants differ by a few per cent) or closer than that of the coarser two by nearly a half.
TEST_P(ManufacturedAttachment, ConvergesWithOneOrderMoreThanTheElements)
{
    const auto& [element_order, coarsest] = GetParam();
    pbs::TetMesh mesh = jittered_cube(coarsest);
    std::vector<double> errors;
    for (int level = 0; level < 3; ++level) {
        errors.insert(errors.begin(), error_of(mesh, element_order));
        mesh = pbs::refine(mesh).mesh;
    }
    const double order = element_order + 1, coarser = std::abs(std::log2(errors[2] / errors[1]) - order),
                 finer = std::abs(std::log2(errors[1] / errors[0]) - order);
    RecordProperty("order_differs_by", std::to_string(finer));
    EXPECT_LT(finer, std::max(0.1, 0.6 * coarser));
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, ManufacturedAttachment, testing::Values(std::pair(1, 4), std::pair(2, 2)));

// Springs of twice or half the weight pull with another force than the body force balances. Where they are stiff, the
// flesh then moves by the offset times 1 / 2 or 1; right ones leave only the error of the elements and of the sample
// points.
TEST(ManufacturedSpringsTest, OfAnotherWeightLeaveAnotherForce)
{
    const pbs::Vec3 large_offset(0.02, -0.01, 0.03);
    const pbs::TetMesh mesh = jittered_cube(8);
    const double right = error_of(mesh, 1, {large_offset});
    for (const double weight : {0.5, 2.0}) EXPECT_GT(error_of(mesh, 1, {large_offset, weight}), 3.0 * right) << weight;
}

// Reference: the theory of quadrature. Twice as many sample points of the springs in every direction are a finer
// midpoint rule, whose error falls to a quarter. The body is the bar of two bones, bent by 40 degrees, with stable
// neo-Hookean flesh.

// Errors of order h^2 leave a quarter of the first difference: |x_2 - x_4| = (1/4 - 1/16) C, |x_1 - x_2| = (1 - 1/4) C.
// Points that fall into other tets add an error that is not smooth, so that the test requires a half instead of a
// quarter.
TEST(SmoothAttachment, MoreSamplePointsChangeLessAndLess)
{
    const pbs::Character middle_bar = bar_character({16, 4, 4});
    std::vector<Positions> shapes;
    for (const int samples : {1, 2, 4}) {
        ElasticFemDeformer fem(
            {.model = reference_fem::Model::stable_neo_hookean, .element_order = 1, .attachment_samples = samples});
        fem.reset(middle_bar);
        EXPECT_EQ(fem.advance(turned(40.0), 0.01).outcome, pbs::Outcome::finished);
        EXPECT_EQ(fem.record()["newton"]["most_inverted_points"].get<int>(), 0);
        shapes.push_back(fem.positions());
    }
    const double first = (shapes[1] - shapes[0]).norm(), second = (shapes[2] - shapes[1]).norm();
    const double motion = (shapes[2] - middle_bar.mesh.rest).norm();
    RecordProperty("first_change_over_motion", std::to_string(first / motion * 1e6) + "e-6");
    RecordProperty("second_change_over_motion", std::to_string(second / motion * 1e6) + "e-6");
    EXPECT_LT(second, 0.5 * first);
    EXPECT_LT(first, 1e-3 * motion);
}

}  // namespace
