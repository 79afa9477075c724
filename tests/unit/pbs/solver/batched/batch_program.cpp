// Reference: the groups from which a program was made, found again lane by lane; and the condition on which threads
// rely: slabs of one parity have no vertex in common, including dummies.

#include "pbs/geometry/topology.hpp"
#include "pbs/solver/batched/batch_program.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

#include <gtest/gtest.h>

#include <set>

namespace batch_program_tests {
namespace {

using namespace test_support;
using pbs::BatchProgram;
using pbs::ConstraintKind;
using pbs::PackedConstraint;
using pbs::VertexOrder;

template <typename Scalar>
class BatchPrograms : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BatchPrograms, Scalars);

// Calls f(batch) for every batch of a slab.
template <typename Scalar, typename F>
void for_each_batch(const BatchProgram<Scalar>& program, int slab, F f)
{
    for (const pbs::BatchRun& run : program.runs(slab))
        pbs::with_kind(run.kind, [&](auto kind) {
            const auto* batches = static_cast<const pbs::Batch<Scalar, kind()>*>(program.batches(run));
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(batches) % 64, 0u);
            for (int b = 0; b < run.count; ++b) f(batches[b]);
        });
}

// A constraint is identified by its rest value, 1 + its index in the class.
template <typename Scalar>
pbs::ConstraintValues<Scalar> numbered(std::size_t constraints)
{
    pbs::ConstraintValues<Scalar> values;
    for (std::size_t c = 0; c < constraints; ++c) {
        values.rest.push_back(Scalar(1 + c));
        values.stiffness.push_back(Scalar(c % 7 + 1) / 8);
    }
    return values;
}

// Compares every lane of a program with the constraints from which it was made.
template <typename Scalar, std::size_t corners>
struct ReadBack {
    const std::vector<std::array<int, corners>>& constraints;
    const VertexOrder& order;
    int dummy_begin;

    pbs::ConstraintValues<Scalar> values = numbered<Scalar>(constraints.size());
    std::vector<int> slab_of = order.slab_of_new();
    std::vector<int> uses = std::vector<int>(constraints.size(), 0);  // how often each constraint occurs
    // vertices of each slab, in the new order
    std::vector<std::set<int>> touched = std::vector<std::set<int>>(order.slabs());
    int groups = 0;

    void read(const BatchProgram<Scalar>& program)
    {
        for (int slab = 0; slab < order.slabs(); ++slab)
            for_each_batch(program, slab, [&](const auto& batch) {
                std::set<int> in_batch;
                for (int lane = 0; lane < pbs::batch_size; ++lane) {
                    read_vertices(batch, lane, slab, in_batch);
                    read_constraint(batch, lane);
                }
                touched[slab].insert(in_batch.begin(), in_batch.end());
            });
    }

    void read_vertices(const auto& batch, int lane, int slab, std::set<int>& in_batch)
    {
        int first = batch.offset[0][lane] / 4, last = first;
        for (const auto& offset : batch.offset) {
            const int vertex = offset[lane] / 4;
            EXPECT_TRUE(in_batch.insert(vertex).second) << "two lanes write vertex " << vertex;
            first = std::min(first, vertex);
            last = std::max(last, vertex);
        }
        const bool is_group = first < static_cast<int>(slab_of.size());
        groups += is_group;
        EXPECT_EQ(is_group ? slab_of[first] : (first - dummy_begin) / BatchProgram<Scalar>::dummies_a_slab, slab);
        EXPECT_LE(is_group ? slab_of[last] : (last - dummy_begin) / BatchProgram<Scalar>::dummies_a_slab,
                  slab + is_group);
    }

    void read_constraint(const auto& batch, int lane)
    {
        const int constraint = static_cast<int>(batch.rest[lane]) - 1;
        EXPECT_EQ(batch.stiffness[lane], constraint < 0 ? Scalar(0) : values.stiffness[constraint]);
        if (constraint < 0) return;
        ++uses[constraint];
        for (std::size_t v = 0; v < corners; ++v)
            EXPECT_EQ(order.old_of_new[batch.offset[v][lane] / 4], constraints[constraint][v]);
    }
};

// Checks slabs 0, 2, 4 ... and slabs 1, 3, 5 ... separately.
void expect_disjoint(const std::vector<std::set<int>>& touched_by)
{
    for (const std::size_t parity : {0, 1}) {
        std::set<int> touched;
        for (std::size_t slab = parity; slab < touched_by.size(); slab += 2)
            for (const int vertex : touched_by[slab])
                EXPECT_TRUE(touched.insert(vertex).second) << "vertex " << vertex << " slab " << slab;
    }
}

template <typename Scalar, std::size_t corners>
void expect_sound(const std::vector<PackedConstraint>& groups, const std::vector<std::array<int, corners>>& constraints,
                  const VertexOrder& order)
{
    const int dummy_begin = 16 * ((static_cast<int>(order.old_of_new.size()) + 15) / 16);
    const BatchProgram<Scalar> program(groups, numbered<Scalar>(constraints.size()), order, dummy_begin);
    ReadBack<Scalar, corners> found{constraints, order, dummy_begin};
    found.read(program);
    EXPECT_EQ(std::count(found.uses.begin(), found.uses.end(), 1), std::ptrdiff_t(constraints.size()));
    EXPECT_EQ(found.groups, int(groups.size()));
    EXPECT_DOUBLE_EQ(program.fill(), double(groups.size()) / (16.0 * program.batches()));
    expect_disjoint(found.touched);
}

template <typename Scalar>
void expect_sound(const pbs::Tets& tets, int vertices, int vertices_a_slab)
{
    const VertexOrder order = pbs::order_vertices(tets, vertices, vertices_a_slab);
    const auto edges = rows_of(pbs::edges_of(tets));
    const auto rows = rows_of(tets);
    expect_sound<Scalar>(pbs::packed_edges(edges), edges, order);
    expect_sound<Scalar>(pbs::packed_tets(rows), rows, order);
}

// Checks that a cluster has its own range of batches.
template <typename Scalar>
void expect_two_runs(const std::vector<PackedConstraint>& groups, ConstraintKind kind, const VertexOrder& order)
{
    const BatchProgram<Scalar> program(groups, numbered<Scalar>(groups.size()), order,
                                       static_cast<int>(order.old_of_new.size()));
    ASSERT_EQ(program.runs(0).size(), 2u);
    for (const pbs::BatchRun& run : program.runs(0)) EXPECT_EQ(run.kind, kind);
}

const pbs::TetMesh bar = structured_bar({0, 0, 0}, {20, 3, 3}, {20, 3, 3});
const int bar_vertices = static_cast<int>(bar.rest.rows());

TYPED_TEST(BatchPrograms, OfManyMeshesInSlabsOfManySizes)
{
    for (const int vertices_a_slab : {1, 30, 1000}) {
        expect_sound<TypeParam>(bar.tets, bar_vertices, vertices_a_slab);
        expect_sound<TypeParam>(shuffled(bar.tets, bar_vertices, 11), bar_vertices, vertices_a_slab);
    }
    for (int count = 1; count < 8; ++count) expect_sound<TypeParam>(tet_ring(count, count > 2), count + 3, 1);
    const pbs::Tets with_unused =
        beside(beside(bar.tets, bar_vertices + 3, tet_ring(5, true)), bar_vertices + 12, bar.tets);
    for (const int vertices_a_slab : {1, 30})
        expect_sound<TypeParam>(with_unused, 2 * bar_vertices + 15, vertices_a_slab);
}

TYPED_TEST(BatchPrograms, SeveralClustersInASlab)
{
    // 15,000 tets: clusters of 8192 and the rest
    const pbs::TetMesh large = structured_bar({0, 0, 0}, {25, 10, 10}, {25, 10, 10});
    const int vertices = static_cast<int>(large.rest.rows());
    expect_sound<TypeParam>(large.tets, vertices, 100000);
    const VertexOrder order = pbs::order_vertices(large.tets, vertices, 100000);
    ASSERT_EQ(order.slabs(), 1);
    expect_two_runs<TypeParam>(pbs::packed_tets(rows_of(large.tets)), ConstraintKind::tet, order);
    expect_two_runs<TypeParam>(pbs::packed_edges(rows_of(pbs::edges_of(large.tets))), ConstraintKind::edge, order);
}

TYPED_TEST(BatchPrograms, NoGroupsAreNoBatches)
{
    const BatchProgram<TypeParam> program({}, {}, pbs::order_vertices(bar.tets, bar_vertices, 30), bar_vertices);
    EXPECT_EQ(program.batches(), 0);
    EXPECT_EQ(program.fill(), 1.0);
    for (int slab = 0; slab < program.slabs(); ++slab) EXPECT_TRUE(program.runs(slab).empty());
}

// The sequence in which the form for several poses projects: the same constraints, sixteen in a row without a common
// vertex.
TYPED_TEST(BatchPrograms, ConstraintsInTheOrderOfProjection)
{
    const VertexOrder order = pbs::order_vertices(bar.tets, bar_vertices, 30);
    const auto tets = rows_of(bar.tets);
    const BatchProgram<TypeParam> program(pbs::packed_tets(tets), numbered<TypeParam>(tets.size()), order,
                                          bar_vertices);
    std::vector<int> uses(tets.size(), 0);
    program.for_each_constraint([&](const auto& vertex, TypeParam rest, TypeParam stiffness) {
        const int tet = static_cast<int>(rest) - 1;
        ++uses[tet];
        EXPECT_EQ(stiffness, TypeParam(tet % 7 + 1) / 8);
        std::vector<int> old;
        for (const int v : vertex) old.push_back(order.old_of_new[v]);
        EXPECT_TRUE(std::is_permutation(old.begin(), old.end(), tets[tet].begin()));
    });
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), std::ptrdiff_t(tets.size()));
}

}  // namespace
}  // namespace batch_program_tests
