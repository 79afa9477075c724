// Reference: the documented format (a tetrahedron of volume 1/6 and two joints, laid out by hand); each refusal by file
// and field.

#include "experiments/characters/named_bodies.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>
#include <string>

namespace test_support {

// An IQM file (version 2) in memory, a tetrahedron with two joints, which tests write unchanged or damage word by word.
// Its layout follows the description of the format, not the reader.

// Positions [bytes] of the parts that tests alter.
struct IqmPlaces {
    static constexpr std::size_t version = 16, file_size = 20, vertex_count = 16 + 4 * 8, triangle_count = 16 + 4 * 10,
                                 joint_count = 16 + 4 * 13, text = 124, array = text + 16, points = array + 20,
                                 triangles = points + 5 * 12, joints = triangles + 4 * 12, end = joints + 2 * 48;
};

template <typename Value>
void put(std::string& bytes, std::size_t place, Value value)
{
    std::memcpy(bytes.data() + place, &value, sizeof value);
}

// Five points, the last equal to the first (a seam). The joint "arm" is a child of "root", which is turned by 90
// degrees about z.
inline std::string iqm_bytes()
{
    using P = IqmPlaces;
    std::string bytes(P::end, '\0');
    std::memcpy(bytes.data(), "INTERQUAKEMODEL", 15);
    const std::uint32_t header[27] = {2, P::end,   0, 16,           P::text, 0, 0,        1,
                                      5, P::array, 4, P::triangles, 0,       2, P::joints};
    for (std::size_t word = 0; word < 27; ++word) put(bytes, 16 + 4 * word, header[word]);
    std::memcpy(bytes.data() + P::text, "\0root\0arm\0", 10);
    const std::uint32_t array[5] = {0, 0, 7, 3, P::points};
    for (std::size_t word = 0; word < 5; ++word) put(bytes, P::array + 4 * word, array[word]);
    const float points[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    for (std::size_t i = 0; i < 15; ++i) put(bytes, P::points + 4 * i, points[i]);
    const std::uint32_t corners[12] = {4, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};  // clockwise as seen from outside
    for (std::size_t i = 0; i < 12; ++i) put(bytes, P::triangles + 4 * i, corners[i]);
    const float half = 0.70710678F;
    const float joints[2][10] = {{0, 0, 2, 0, 0, half, half, 1, 1, 1}, {3, 0, 0, 0, 0, 0, 1, 1, 1, 1}};
    const std::int32_t names[2] = {1, 6}, parents[2] = {-1, 0};
    for (std::size_t j = 0; j < 2; ++j) {
        put(bytes, P::joints + 48 * j, names[j]);
        put(bytes, P::joints + 48 * j + 4, parents[j]);
        for (std::size_t i = 0; i < 10; ++i) put(bytes, P::joints + 48 * j + 8 + 4 * i, joints[j][i]);
    }
    return bytes;
}

}  // namespace test_support

namespace {

using Iqm = test_support::FolderTest;
using namespace pbs;
using P = test_support::IqmPlaces;
TEST_F(Iqm, TrianglesTurnOutwardAndSeamsAreJoined)
{
    const IqmModel model = read_iqm(folder.file("tet.iqm", test_support::iqm_bytes()));
    EXPECT_EQ(model.surface.points.rows(), 4);
    ASSERT_EQ(model.surface.triangles.rows(), 4);
    EXPECT_DOUBLE_EQ(test_support::enclosed_volume(model.surface.points, model.surface.triangles), 1.0 / 6.0);
}

TEST_F(Iqm, JointsStandWhereTheirParentsTurnThem)
{
    const IqmModel model = read_iqm(folder.file("tet.iqm", test_support::iqm_bytes()));
    ASSERT_EQ(model.joints.size(), 2u);
    EXPECT_EQ(model.joints[0].name, "root");
    EXPECT_EQ(model.joints[1].name, "arm");
    EXPECT_EQ(model.joints[1].parent, 0);
    // The joint is 3 along the root's x, which is the world's y, from a height of 2. The quaternion's two equal
    // components in single precision become those of a quarter turn when it is normalised in double precision.
    EXPECT_NEAR((model.joints[1].position - Vec3(0.0, 3.0, 2.0)).norm(), 0.0, test_support::motion_error(2, 3.0 + 2.0));
}

TEST_F(Iqm, EveryTruncationIsRefused)
{
    const std::string whole = test_support::iqm_bytes();
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += 7) {
        const std::string path = folder.file("cut.iqm", whole.substr(0, bytes));
        EXPECT_THROW(read_iqm(path), InputError) << bytes;
        if (bytes < P::text) continue;
        std::string consistent = whole.substr(0, bytes);  // its header states the reduced length
        test_support::put(consistent, P::file_size, static_cast<std::uint32_t>(bytes));
        const std::string same = folder.file("cut.iqm", consistent);
        EXPECT_THROW(read_iqm(same), InputError) << bytes;
    }
}

struct Damage {
    const char* name;
    std::size_t place;
    std::uint32_t word;
    const char* field;
};

class DamagedIqm : public testing::TestWithParam<Damage> {};

TEST_P(DamagedIqm, IsRefusedByFileAndField)
{
    const test_support::ScratchFolder folder;
    std::string bytes = test_support::iqm_bytes();
    test_support::put(bytes, GetParam().place, GetParam().word);
    const std::string path = folder.file("bad.iqm", bytes);
    expect_input_error([&] { read_iqm(path); }, path + ": ", GetParam().field);
}

constexpr std::uint32_t nan_bits = 0x7fc00000, huge = 0xfffffff0;
INSTANTIATE_TEST_SUITE_P(Iqm, DamagedIqm,
                         testing::Values(Damage{"magic", 0, 0, "magic"}, Damage{"version", P::version, 1, "version"},
                                         Damage{"file_size", P::file_size, 7, "filesize"},
                                         Damage{"more_vertices", P::vertex_count, 1000, "vertexarrays.position"},
                                         Damage{"huge_vertices", P::vertex_count, huge, "vertexarrays.position"},
                                         Damage{"fewer_vertices", P::vertex_count, 3, "triangles"},
                                         Damage{"no_triangles", P::triangle_count, 0, "num_triangles"},
                                         Damage{"huge_triangles", P::triangle_count, huge, "ofs_triangles"},
                                         Damage{"huge_joints", P::joint_count, huge, "ofs_joints"},
                                         Damage{"no_positions", P::array, 1, "vertexarrays.position"},
                                         Damage{"positions_of_bytes", P::array + 8, 1, "vertexarrays.position"},
                                         Damage{"positions_beyond", P::array + 16, huge, "vertexarrays.position"},
                                         Damage{"nan_position", P::points, nan_bits, "vertexarrays.position"},
                                         Damage{"corner_out_of_range", P::triangles, 5, "triangles"},
                                         Damage{"name_beyond", P::joints, 400, "name"},
                                         Damage{"its_own_parent", P::joints + 52, 1, "parent"},
                                         Damage{"nan_joint", P::joints + 8, nan_bits, "joint root"},
                                         Damage{"no_rotation", P::joints + 48 + 8 + 24, 0, "joint arm"}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
