// Reference: the condition on which threads rely. A group of constraints contains at most one vertex and all its
// neighbours, so slabs of one parity share nothing if no such star extends beyond the slab of its first vertex and the
// next one.

#include "pbs/geometry/topology.hpp"
#include "pbs/packed/vertex_order.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

#include <gtest/gtest.h>

namespace vertex_order_tests {
namespace {

using namespace test_support;
using pbs::order_vertices;
using pbs::Tets;
using pbs::VertexOrder;

void expect_permutation(const VertexOrder& order, int vertices)
{
    ASSERT_EQ(order.old_of_new.size(), std::size_t(vertices));
    ASSERT_EQ(order.new_of_old.size(), std::size_t(vertices));
    std::vector<int> sorted = order.old_of_new;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < vertices; ++i) {
        ASSERT_EQ(sorted[i], i);
        ASSERT_EQ(order.new_of_old[order.old_of_new[i]], i);
    }
}

void expect_slab_sizes(const VertexOrder& order, int vertices, int vertices_a_slab)
{
    ASSERT_GE(order.slabs(), 1);
    EXPECT_EQ(order.slab_begin.front(), 0);
    EXPECT_EQ(order.slab_begin.back(), vertices);
    for (int slab = 0; order.slabs() > 1 && slab < order.slabs(); ++slab) {
        const int size = order.slab_begin[slab + 1] - order.slab_begin[slab];
        const bool is_first = slab == 0, is_last = slab + 1 == order.slabs();
        EXPECT_GE(size, is_last    ? vertices_a_slab / 3
                        : is_first ? vertices_a_slab / 2
                                   : vertices_a_slab)
            << "slab " << slab;
    }
}

// Checks the first and last slab among each vertex and its neighbours, which bound the extent of a group.
void expect_stars_in_two_slabs(const VertexOrder& order, const Tets& tets)
{
    const std::vector<int> slab_of = order.slab_of_new();
    std::vector<int> first(slab_of.size()), last;
    for (std::size_t i = 0; i < first.size(); ++i) first[i] = slab_of[order.new_of_old[i]];
    last = first;
    for (const auto& edge : rows_of(pbs::edges_of(tets)))
        for (const auto& [i, j] : {std::pair(edge[0], edge[1]), std::pair(edge[1], edge[0])}) {
            first[i] = std::min(first[i], slab_of[order.new_of_old[j]]);
            last[i] = std::max(last[i], slab_of[order.new_of_old[j]]);
        }
    for (std::size_t i = 0; i < first.size(); ++i) ASSERT_LE(last[i] - first[i], 1) << "vertex " << i;
}

VertexOrder expect_sound(const Tets& tets, int vertices, int vertices_a_slab)
{
    const VertexOrder order = order_vertices(tets, vertices, vertices_a_slab);
    expect_permutation(order, vertices);
    expect_slab_sizes(order, vertices, vertices_a_slab);
    expect_stars_in_two_slabs(order, tets);
    return order;
}

const pbs::TetMesh bar = structured_bar({0, 0, 0}, {40, 3, 3}, {40, 3, 3});
const int bar_vertices = static_cast<int>(bar.rest.rows());

TEST(VertexOrder, IsSoundForSlabsOfManySizes)
{
    const Tets two = beside(bar.tets, bar_vertices, shuffled(bar.tets, bar_vertices, 9));
    const Tets three = beside(two, 2 * bar_vertices, tet_ring(5, true)), after = (bar.tets.array() + 7).matrix();
    // each with a level of one vertex and one of three: the end of one and the start of the next share slabs
    Tets apart(0, 4);
    for (int t = 0; t < 20; ++t) apart = beside(apart, 4 * t, tet_ring(1, false));
    struct Case {
        const char* name;
        Tets tets;
        int vertices;
        std::vector<int> vertices_a_slab;
    };
    const Case cases[] = {
        {"a bar", bar.tets, bar_vertices, {1, 2, 16, 17, 100, 1024}},
        {"in any numbering", shuffled(bar.tets, bar_vertices, 7), bar_vertices, {1, 2, 16, 17, 100, 1024}},
        {"one tet", tet_ring(1, false), 4, {1}},
        {"vertices alone", Tets(0, 4), 5, {1}},
        {"unused vertices behind", bar.tets, bar_vertices + 7, {1, 3, 100}},
        {"unused vertices before and behind", after, bar_vertices + 14, {1, 3, 100}},
        {"three components", three, 2 * bar_vertices + 7, {1, 2, 5, 100}},
        {"three components in any numbering",
         shuffled(three, 2 * bar_vertices + 7, 10),
         2 * bar_vertices + 7,
         {1, 2, 5, 100}},
        {"many small components", apart, 80, {1, 4, 7}},
    };
    for (const auto& [name, tets, vertices, sizes] : cases)
        for (const int vertices_a_slab : sizes) {
            SCOPED_TRACE(testing::Message() << name << " in slabs of " << vertices_a_slab);
            expect_sound(tets, vertices, vertices_a_slab);
        }
    EXPECT_EQ(expect_sound(tet_ring(1, false), 4, 1024).slabs(), 1);
    EXPECT_LE(expect_sound(tet_ring(300, true), 302, 16).slabs(), 2) << "all vertices around one";
    const VertexOrder empty = order_vertices(Tets(0, 4), 0, 1);
    EXPECT_EQ(empty.slabs(), 1);
    EXPECT_TRUE(empty.old_of_new.empty() && empty.slab_of_new().empty());
}

TEST(VertexOrder, SlabsAreAsManyAsTheSizeAsksFor)
{
    EXPECT_GE(order_vertices(bar.tets, bar_vertices, 1).slabs(), 20);  // 40 or more levels, two per slab
    EXPECT_EQ(order_vertices(bar.tets, bar_vertices, bar_vertices).slabs(), 1);
    const int slabs = order_vertices(bar.tets, bar_vertices, bar_vertices / 8).slabs();
    EXPECT_GE(slabs, 4);
    EXPECT_LE(slabs, 8);
}

TEST(VertexOrder, NeighboursAreNearInMemoryHoweverTheMeshIsNumbered)
{
    const Tets tets = shuffled(bar.tets, bar_vertices, 8);
    const VertexOrder order = order_vertices(tets, bar_vertices, 1024);
    int bandwidth = 0;
    for (const auto& edge : rows_of(pbs::edges_of(tets)))
        bandwidth = std::max(bandwidth, std::abs(order.new_of_old[edge[0]] - order.new_of_old[edge[1]]));
    EXPECT_LE(bandwidth, 4 * 16);  // two levels, each with hardly more than the 16 vertices of a section
}

// Reference: the definition of a colouring, checked tet by tet.

// The colour of each vertex, -1 for none; a vertex with two colours is a failure.
std::vector<int> colour_of_vertex(const std::vector<std::vector<int>>& colours, int vertices)
{
    std::vector<int> colour_of(vertices, -1);
    for (std::size_t colour = 0; colour < colours.size(); ++colour)
        for (const int vertex : colours[colour]) {
            EXPECT_EQ(colour_of[vertex], -1) << vertex;
            colour_of[vertex] = static_cast<int>(colour);
        }
    return colour_of;
}

void expect_colouring(const pbs::Tets& tets, int vertices)
{
    const std::vector<int> colour_of = colour_of_vertex(pbs::vertex_colours(tets, vertices), vertices);
    for (const int colour : colour_of) EXPECT_GE(colour, 0);
    for (const auto& tet : tets.rowwise())
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) EXPECT_NE(colour_of[tet(i)], colour_of[tet(j)]);
}

TEST(VertexColours, NoTwoVerticesOfATetHaveOneColour)
{
    const pbs::TetMesh bar = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {5, 4, 3});
    expect_colouring(bar.tets, static_cast<int>(bar.rest.rows()));
    expect_colouring(test_support::shuffled(bar.tets, static_cast<int>(bar.rest.rows()), 5),
                     static_cast<int>(bar.rest.rows()));
    expect_colouring(test_support::tet_ring(7, true), 9);
}

// A vertex has at most 14 neighbours in Kuhn's split.
TEST(VertexColours, AreAtMostOneMoreThanTheLargestNumberOfNeighboursAndFourOfOneTet)
{
    const pbs::TetMesh bar = test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {6, 6, 6});
    EXPECT_LE(pbs::vertex_colours(bar.tets, static_cast<int>(bar.rest.rows())).size(), 15u);
    const auto colours = pbs::vertex_colours(test_support::tet_ring(1, false), 5);
    EXPECT_EQ(colours.size(), 4u);
    EXPECT_EQ(colour_of_vertex(colours, 5)[4], 0) << "a vertex without tets has the first";
    EXPECT_TRUE(pbs::vertex_colours(pbs::Tets(0, 4), 0).empty());
}

}  // namespace
}  // namespace vertex_order_tests
