// Reference: HOBAK's format by hand: lines "v x y z" and "t a b c d", vertices counted from 0.
#include "pbs/geometry/mesh_io.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/support/unit_tet.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

const std::string unit_points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(Tobj, HasVerticesAndTets)
{
    const test_support::ScratchFolder folder;
    const pbs::MeshReading reading = pbs::read_tet_mesh(folder.file("a.tobj", unit_points + "t 0 1 2 3\n"));
    EXPECT_EQ(reading.mesh.rest, test_support::unit_tet().rest);
    EXPECT_EQ(reading.mesh.tets, test_support::unit_tet().tets);
}

TEST(Tobj, MayHaveCommentsTrianglesWindowsLineEndsAndExponents)
{
    const test_support::ScratchFolder folder;
    const std::string text = "# a tet\r\nv 0 0 0\r\nv 1e0 0 0\r\n\r\nv 0 1 0\r\nt 0 1 2 3\r\nf 1 2 3\r\nv 0 0 1\r\n";
    EXPECT_EQ(pbs::read_tet_mesh(folder.file("a.TOBJ", text)).mesh.rest, test_support::unit_tet().rest);
}

struct BadTobj {
    const char* name;
    std::string text, begins, holds;
};

class RefusedTobj : public testing::TestWithParam<BadTobj> {};

TEST_P(RefusedTobj, NamesFileLineFieldAndRule)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("bad.tobj", GetParam().text);
    expect_input_error([&] { pbs::read_tet_mesh(path); }, path + GetParam().begins, GetParam().holds);
}

const BadTobj bad_tobj[] = {
    {"two_coordinates", "v 0 0\n", ":1: v = v 0 0: ", "expected 3 numbers"},
    {"four_coordinates", "v 0 0 0 0\n", ":1: v = ", "expected 3 numbers"},
    {"coordinate_is_text", "v 0 0 x\n", ":1: v = x: ", "expected a number"},
    {"coordinate_with_comma", "v 0 0 1,5\n", ":1: v = 1,5: ", "expected a number"},
    {"coordinate_nan", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2 3\n", ": vertex 0", "finite"},
    {"three_corners", unit_points + "t 0 1 2\n", ":5: t = ", "expected 4 numbers"},
    {"corner_out_of_range", unit_points + "t 0 1 2 4\n", ":5: t = 4: ", "expected an index from 0 to 3"},
    {"corner_negative", unit_points + "t 0 1 2 -1\n", ":5: t = -1: ", "expected the number of a vertex, from 0"},
    {"corner_not_whole", unit_points + "t 0 1 2 2.5\n", ":5: t = 2.5: ", "expected the number of a vertex, from 0"},
    {"corner_nan", unit_points + "t 0 1 2 nan\n", ":5: t = nan: ", "expected the number of a vertex, from 0"},
    {"corner_huge", unit_points + "t 0 1 2 1e300\n", ":5: t = 1e+300: ", "expected the number of a vertex, from 0"},
    {"no_vertices", "t 0 1 2 3\n", ": points = 0: ", "at least one point"},
    {"no_tets", unit_points, ": tets = 0: ", "at least one tetrahedron"},
    {"empty", "", ": ", "the file is empty"},
};

INSTANTIATE_TEST_SUITE_P(Tobj, RefusedTobj, testing::ValuesIn(bad_tobj), [](const auto& info) { return std::string(info.param.name); });

}  // namespace
