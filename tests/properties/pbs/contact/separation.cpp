// Reference: the same run without contact, or on one thread, and the search for skin in flesh of another part
// (SelfContact).
#include "pbs/contact/self_contact.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include "tests/support/four_threads.hpp"
#include "tests/support/overlapping_blocks.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace separation_tests {
namespace {

using namespace test_support;
using pbs::Order;
using pbs::PbsOptions;
using pbs::Positions;
using pbs::Precision;
using pbs::Vec3;

const TwoBoneLimb bent = two_bone_limb({48, 8, 8}, Vec3::UnitZ(), 110.0),
                  folded = two_bone_limb({24, 4, 4}, Vec3::UnitZ(), 150.0);

class ContactIn : public testing::TestWithParam<std::tuple<Order, Precision>> {
protected:
    PbsOptions options(bool contact) const
    {
        PbsOptions options;
        std::tie(options.order, options.precision) = GetParam();
        options.contact = contact;
        return options;
    }
};

// The sum of the depths of skin in flesh of another part [m].
double overlap_m(const pbs::TetMesh& mesh, const Positions& x)
{
    pbs::SelfContact<double> contact(mesh, in_order(x.rows()), 3);
    contact.find(x.data());
    double sum = 0.0;
    for (const auto& constraint : contact.constraints()) sum += constraint.depth;
    return sum;
}

Positions advanced(const pbs::TetMesh& mesh, const Eigen::VectorXd& distance, const Positions& lbs, const Positions& q,
                   const PbsOptions& options)
{
    pbs::PbsSolver solver(mesh, distance, {}, options);
    EXPECT_EQ(solver.advance(lbs, q, 0.01).outcome, pbs::Outcome::finished);
    return solver.positions();
}

TEST_P(ContactIn, SeparatesBlocksAndKeepsTheirMomentum)
{
    const OverlappingBlocks blocks = overlapping_blocks(0.15);
    PbsOptions with = options(true), without = options(false);
    with.k_bind = without.k_bind = 0.0;
    const Eigen::VectorXd distance = Eigen::VectorXd::Zero(blocks.mesh.rest.rows());
    const Positions x = advanced(blocks.mesh, distance, blocks.pushed, blocks.pushed, with);
    const double before_m = overlap_m(blocks.mesh, blocks.pushed);
    EXPECT_GT(before_m, 1.0);
    EXPECT_NEAR(overlap_m(blocks.mesh, advanced(blocks.mesh, distance, blocks.pushed, blocks.pushed, without)),
                before_m, 1e-3);
    EXPECT_LE(overlap_m(blocks.mesh, x), 0.05 * before_m);
    const Eigen::RowVector3d drift = (x - blocks.pushed).colwise().sum();
    // in float relative to the mean position
    EXPECT_LE(drift.norm(), 1e-3 * (x - blocks.pushed).rowwise().norm().sum());
}

TEST_P(ContactIn, TakesTheOverlapOutOfABentLimb)
{
    const double without_m =
        overlap_m(bent.mesh, advanced(bent.mesh, bent.binding.distance, bent.lbs, bent.bind_points, options(false)));
    const double with_m =
        overlap_m(bent.mesh, advanced(bent.mesh, bent.binding.distance, bent.lbs, bent.bind_points, options(true)));
    EXPECT_GT(without_m, 1.0);
    EXPECT_LE(with_m, 0.2 * without_m);
}

TEST_P(ContactIn, ChangesNoBitWhereNothingOverlaps)
{
    TwoBoneLimb limb = two_bone_limb({24, 4, 4}, Vec3::UnitZ(), 30.0);
    EXPECT_EQ(overlap_m(limb.mesh, limb.lbs), 0.0);
    pbs::PbsSolver with(limb.mesh, limb.binding.distance, {}, options(true)),
        without(limb.mesh, limb.binding.distance, {}, options(false));
    with.advance(folded.lbs, folded.bind_points, 0.01);  // what a frame has found does not last
    for (pbs::PbsSolver* solver : {&with, &without}) solver->advance(limb.lbs, limb.bind_points, 0.01);
    EXPECT_EQ(with.positions(), without.positions());
}

TEST_P(ContactIn, StaysBoundedFromTeleportedCollapsedAndMirroredStatesWithTimeStepsUpToASecond)
{
    Positions point = Positions::Zero(folded.lbs.rows(), 3), mirrored = folded.lbs, torn = folded.lbs;
    mirrored.col(1) *= -1.0;
    for (Eigen::Index v = 0; v < torn.rows(); v += 9) torn.row(v).array() += 100.0;
    std::vector<bool> jiggles(folded.lbs.rows());
    for (Eigen::Index v = 0; v < folded.lbs.rows(); ++v) jiggles[v] = folded.mesh.rest(v, 0) > 0.3;
    for (const double dt_s : {0.01, 0.1, 1.0})
        for (const Positions& start : {point, mirrored, torn}) {
            PbsOptions jiggling = options(true);
            jiggling.jiggle = pbs::Jiggle{0.1};
            pbs::PbsSolver solver(folded.mesh, folded.binding.distance, jiggles, jiggling);
            solver.advance(start, folded.bind_points, dt_s);
            double largest_m = 0.0;
            for (int step = 0; step < 30; ++step) {
                EXPECT_EQ(solver.advance(folded.lbs, folded.bind_points, dt_s).outcome, pbs::Outcome::finished);
                if (step >= 20) largest_m = std::max(largest_m, solver.positions().rowwise().norm().maxCoeff());
            }
            EXPECT_LE(largest_m, 5.0) << "time step " << dt_s;  // the limb reaches 1.1 m from its joint
        }
}

std::string name_of_case(const testing::TestParamInfo<std::tuple<Order, Precision>>& info)
{
    const char* const orders[] = {"plain", "ordered"};
    return std::string(orders[int(std::get<0>(info.param))]) +
           (std::get<1>(info.param) == Precision::f32 ? "_f32" : "_f64");
}

INSTANTIATE_TEST_SUITE_P(Orders, ContactIn,
                         testing::Combine(testing::Values(Order::plain, Order::ordered),
                                          testing::Values(Precision::f32, Precision::f64)),
                         name_of_case);

TEST(Contact, NumberOfThreadsChangesNoBit)
{
    const TwoBoneLimb limb = two_bone_limb({250, 8, 8}, Vec3::UnitZ(), 110.0);  // 20,331 vertices
    for (const Precision precision : {Precision::f32, Precision::f64}) {
        Positions of_one;
        for (const int threads : {1, 2, 4}) {
            PbsOptions options;
            options.contact = true;
            options.precision = precision;
            options.threads = threads;
            options.iterations = 4;
            pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, options);
            solver.advance(limb.lbs, limb.bind_points, 0.01);
            if (threads == 1) of_one = solver.positions();
            EXPECT_TRUE(solver.positions() == of_one) << threads;
        }
    }
}

}  // namespace
}  // namespace separation_tests
