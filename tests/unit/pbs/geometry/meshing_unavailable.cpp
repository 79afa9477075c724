// Reference: a build without meshing states that in its errors.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Meshing, LeftOutSaysWhichOptionBringsItBack)
{
    try {
        pbs::mesh_limb(1775);
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("PBS_WITH_CGAL"), std::string::npos) << error.what();
    }
    EXPECT_THROW(pbs::mesh_surface({}, {}), pbs::InputError);
    EXPECT_THROW(pbs::points_inside({}, {}, {}), pbs::InputError);
}

}  // namespace
