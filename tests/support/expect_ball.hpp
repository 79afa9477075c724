// A tet mesh that is a ball, or with Euler number 0 a body with one handle, of tets that the mesher promises.
#pragma once

#include "pbs/geometry/topology.hpp"

#include <gtest/gtest.h>

namespace test_support {

inline void expect_ball(const pbs::Quality& quality, int boundary_euler = 2)
{
    EXPECT_TRUE(quality.topology.boundary_manifold);
    EXPECT_EQ(quality.topology.boundary_euler, boundary_euler);
    EXPECT_EQ(quality.topology.boundary_components, 1);
    EXPECT_EQ(quality.topology.components, 1);
    EXPECT_EQ(quality.topology.unused_vertices, 0);
    EXPECT_GE(quality.min_dihedral_deg, 5.0);
}

}  // namespace test_support
