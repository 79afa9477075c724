// Reference: the same run on one thread. Threads share a mesh by slabs, which are defined by the mesh, so no number of
// threads and no order of the slabs of one parity changes a bit; nor does a second run.
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/projection.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include "analysis/records/provenance.hpp"
#include "tests/support/four_threads.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace threads_tests {
namespace {

using namespace test_support;
using pbs::Order;
using pbs::PbsOptions;
using pbs::Precision;
using pbs::Vec3;

const TwoBoneLimb limb = two_bone_limb({550, 6, 6}, Vec3::UnitZ(), 60.0);  // 26,999 vertices

template <typename Solver>
using OptionsOf = std::conditional_t<std::is_same_v<Solver, pbs::PbsSolver>, PbsOptions, pbs::XpbdOptions>;

// The hash after three steps, with one jiggling half.
template <typename Solver>
std::string hash_of_run(Order order, Precision precision, int threads, void (*change)(OptionsOf<Solver>&) = nullptr)
{
    OptionsOf<Solver> options;
    options.order = order;
    options.precision = precision;
    options.threads = threads;
    options.iterations = 2;
    if constexpr (std::is_same_v<Solver, pbs::PbsSolver>)
        options.jiggle = pbs::Jiggle{0.1};
    else
        options.substeps = 2, options.jiggle = true;
    if (change) change(options);
    std::vector<bool> jiggles(limb.lbs.rows());
    for (Eigen::Index i = 0; i < limb.lbs.rows(); ++i) jiggles[i] = limb.mesh.rest(i, 0) > 0.0;
    Solver solver(limb.mesh, limb.binding.distance, jiggles, options);
    analysis::StateHash hash;
    for (const auto* lbs : {&limb.mesh.rest, &limb.lbs, &limb.lbs}) {
        solver.advance(*lbs, limb.bind_points, 0.01);
        hash.add(solver.positions());
    }
    return hash.hex();
}

// Four slabs of each parity.
TEST(Threads, TheMeshHasSlabsForFourThreadsAtOnce)
{
    const auto constraints = pbs::make_constraint_set<float>(limb.mesh, limb.binding.distance, {}, {});
    EXPECT_GE(pbs::make_batched_constraints(constraints, limb.mesh.tets).order.slabs(), 8);
}

// A body that is a tenth too large satisfies no constraint, so that every vertex moves.
TEST(Threads, ProjectEverySlab)
{
    for (const int threads : {1, 4}) {
        PbsOptions options;
        options.order = Order::ordered;
        options.threads = threads;
        const auto constraints = pbs::make_constraint_set<double>(limb.mesh, limb.binding.distance, {}, options);
        const auto projection = pbs::make_projection<double>(constraints, limb.mesh.tets, options);
        const pbs::Positions larger = 1.1 * limb.lbs;
        for (const bool stretch : {true, false}) {
            projection->load(larger, limb.bind_points, Vec3::Zero());
            stretch ? projection->project_stretch_constraints() : projection->project_volume_constraints();
            pbs::Positions moved = larger;
            projection->store(Vec3::Zero(), moved);
            EXPECT_EQ(((moved - larger).rowwise().norm().array() == 0.0).count(), 0) << threads << " threads";
        }
    }
}

template <typename Solver>
class ThreadsOf : public testing::Test {
};
using Solvers = testing::Types<pbs::PbsSolver, pbs::XpbdSolver>;
TYPED_TEST_SUITE(ThreadsOf, Solvers);

TYPED_TEST(ThreadsOf, OneTwoAndFourGiveTheSameBitsAndOthersInEachCode)
{
    std::set<std::string> hashes;
    for (const Precision precision : {Precision::f32, Precision::f64}) {
        const std::string alone = hash_of_run<TypeParam>(Order::ordered, precision, 1);
        for (const int threads : {2, 4})
            EXPECT_EQ(hash_of_run<TypeParam>(Order::ordered, precision, threads), alone) << threads << " threads";
        hashes.insert(alone);
    }
    const std::string plain = hash_of_run<TypeParam>(Order::plain, Precision::f32, 1);
    EXPECT_EQ(hash_of_run<TypeParam>(Order::plain, Precision::f32, 2), plain) << "a second run, with two threads";
    hashes.insert(plain);
    EXPECT_EQ(hashes.size(), 3u) << "orders and precisions differ";
}

template <pbs::VolumeOf volume_of>
void change_the_method(PbsOptions& options)
{
    options.k_bind = 0.1;
    options.bind_to = pbs::BindTo::blended_position;
    options.volume_of = volume_of;
    options.k_stretch_length_m = 0.05;
}

// Regions lie across slabs and are projected after them; the blended position is a target of each vertex alone.
TEST(Threads, ChangesToTheMethodGiveTheSameBits)
{
    using enum pbs::VolumeOf;
    std::set<std::string> hashes;
    for (const auto change :
         {change_the_method<tets>, change_the_method<regions>, change_the_method<tets_and_regions>}) {
        const auto hash = [&](int threads) {
            return hash_of_run<pbs::PbsSolver>(Order::ordered, Precision::f32, threads, change);
        };
        const std::string alone = hash(1);
        for (const int threads : {2, 4}) EXPECT_EQ(hash(threads), alone) << threads << " threads";
        hashes.insert(alone);
    }
    EXPECT_EQ(hashes.size(), 3u);
}

struct alignas(64) Block {
    double xyzw[4 * pbs::batch_size];
};

// Projects all volume constraints once, with the slabs of each parity in forward or reverse order.
std::vector<double> projected(const pbs::BatchedConstraints<double>& batched, bool from_the_last)
{
    const int slabs = batched.order.slabs(), dummies = slabs * pbs::BatchProgram<double>::dummies_a_slab;
    std::vector<Block> blocks((batched.dummy_begin + dummies) / pbs::batch_size, Block{});
    double* vertices = blocks.front().xyzw;
    for (int i = 0; i < batched.vertices(); ++i) {
        for (int axis = 0; axis < 3; ++axis) vertices[4 * i + axis] = limb.lbs(batched.order.old_of_new[i], axis);
        vertices[4 * i + 3] = 1.0;
    }
    std::vector<int> order;
    for (const int parity : {0, 1}) {
        const auto begin = order.insert(order.end(), 0, 0);
        const std::ptrdiff_t first = begin - order.begin();
        for (int slab = parity; slab < slabs; slab += 2) order.push_back(slab);
        if (from_the_last) std::reverse(order.begin() + first, order.end());
    }
    for (const int slab : order)
        for (const pbs::BatchRun& run : batched.volume.runs(slab))
            pbs::project_batches(run.kind, batched.volume.batches(run), run.count, vertices);
    return {vertices, vertices + 4 * blocks.size() * pbs::batch_size};
}

// The condition that makes threads safe, tested without threads: if two slabs of one parity touched a vertex, the first
// would move it before the other.
TEST(Threads, SlabsOfOneParityMayComeInAnyOrder)
{
    const auto constraints = pbs::make_constraint_set<double>(limb.mesh, limb.binding.distance, {}, {});
    const auto batched = pbs::make_batched_constraints(constraints, limb.mesh.tets);
    EXPECT_EQ(projected(batched, true), projected(batched, false));
}

}  // namespace
}  // namespace threads_tests
