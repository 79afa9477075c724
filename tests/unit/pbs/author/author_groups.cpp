// First-fit colouring over all kinds of constraints together. Reference: the rule in author_solver.hpp, by hand.
#include "pbs/author/author_solver.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

// Two tets that share the face 1, 2, 3.
const pbs::TetMesh two_tets = [] {
    pbs::TetMesh mesh;
    mesh.rest.resize(5, 3);
    mesh.rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1;
    mesh.tets.resize(2, 4);
    mesh.tets << 0, 1, 2, 3, 4, 2, 1, 3;
    return mesh;
}();
const pbs::Skeleton one_bone = {{{"bone", -1, {0, 0, -1}, {0, 0, 2}}}};

TEST(AuthorGroups, EdgesAreListedAsTheyFirstAppear)
{
    pbs::Edges expected(9, 2);
    expected << 0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3, 2, 4, 1, 4, 3, 4;
    EXPECT_EQ(pbs::edges_by_appearance(two_tets.tets), expected);
}

// Tet 0 leaves vertex 4 free in group 0, and tet 1 leaves vertex 0 free in group 1. The binds of 4 and 0 join these groups; the others open
// group 2. The edges 0-1, 0-2 and 0-3 open groups 3 to 5, which their opposite edges 2-3, 1-3 and 1-2 join. Vertex 4 is still free there,
// but the other end of each of its edges is not: each of them opens a group of its own.
TEST(AuthorGroups, EachConstraintJoinsTheFirstGroupWithoutItsVertices)
{
    const auto groups = pbs::author_groups(two_tets, pbs::bind_to_nearest_bone(two_tets.rest, one_bone));
    std::vector<std::vector<std::vector<int>>> found;
    for (const pbs::AuthorGroup& group : groups) {
        found.emplace_back();
        for (const auto& constraint : group.volume) found.back().emplace_back(constraint.vertex.begin(), constraint.vertex.end());
        for (const auto& constraint : group.bind) found.back().push_back({constraint.vertex});
        for (const auto& constraint : group.stretch) found.back().emplace_back(constraint.vertex.begin(), constraint.vertex.end());
    }
    const decltype(found) expected = {{{0, 1, 2, 3}, {4}},
                                      {{4, 2, 1, 3}, {0}},
                                      {{1}, {2}, {3}},
                                      {{0, 1}, {2, 3}},
                                      {{0, 2}, {1, 3}},
                                      {{0, 3}, {1, 2}},
                                      {{2, 4}},
                                      {{1, 4}},
                                      {{3, 4}}};
    EXPECT_EQ(found, expected);
}

TEST(AuthorGroups, ShareNoVertexAndHoldEachConstraintOnce)
{
    const auto limb = test_support::two_bone_limb({8, 2, 2}, {0, 0, 1}, 0.0);
    Eigen::Index tets = 0, binds = 0, edges = 0;
    for (const pbs::AuthorGroup& group : pbs::author_groups(limb.mesh, limb.binding)) {
        std::vector<int> vertices;
        for (const auto& constraint : group.volume) vertices.insert(vertices.end(), constraint.vertex.begin(), constraint.vertex.end());
        for (const auto& constraint : group.bind) vertices.push_back(constraint.vertex);
        for (const auto& constraint : group.stretch) vertices.insert(vertices.end(), constraint.vertex.begin(), constraint.vertex.end());
        EXPECT_EQ(std::set<int>(vertices.begin(), vertices.end()).size(), vertices.size());
        tets += group.volume.size(), binds += group.bind.size(), edges += group.stretch.size();
    }
    EXPECT_EQ(tets, limb.mesh.tets.rows());
    EXPECT_EQ(binds, limb.mesh.rest.rows());
    EXPECT_EQ(edges, pbs::edges_by_appearance(limb.mesh.tets).rows());
}

TEST(AuthorGroups, RestDataAreThoseOfTheMesh)
{
    pbs::TetMesh inverted = two_tets;
    std::swap(inverted.tets(0, 0), inverted.tets(0, 1));
    const auto groups = pbs::author_groups(inverted, pbs::bind_to_nearest_bone(inverted.rest, one_bone));
    EXPECT_EQ(groups[0].volume[0].rest_volume, 1.0 / 6.0);  // absolute
    EXPECT_EQ(groups[3].stretch[0].rest_length, 1.0);
    EXPECT_EQ(groups[1].bind[0].distance, 0.0);
    EXPECT_EQ(groups[2].bind[0].distance, 1.0);
}

}  // namespace
