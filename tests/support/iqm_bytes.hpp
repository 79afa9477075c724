// An IQM file (version 2) in memory, a tetrahedron with two joints, which tests write unchanged or damage word by word. Its layout follows
// the description of the format, not the reader.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace test_support {

// Positions [bytes] of the parts that tests alter.
struct IqmPlaces {
    static constexpr std::size_t version = 16, file_size = 20, vertex_count = 16 + 4 * 8, triangle_count = 16 + 4 * 10,
                                 joint_count = 16 + 4 * 13, text = 124, array = text + 16, points = array + 20, triangles = points + 5 * 12,
                                 joints = triangles + 4 * 12, end = joints + 2 * 48;
};

template <typename Value>
void put(std::string& bytes, std::size_t place, Value value)
{
    std::memcpy(bytes.data() + place, &value, sizeof value);
}

// Five points, the last equal to the first (a seam). The joint "arm" is a child of "root", which is turned by 90 degrees about z.
inline std::string iqm_bytes()
{
    using P = IqmPlaces;
    std::string bytes(P::end, '\0');
    std::memcpy(bytes.data(), "INTERQUAKEMODEL", 15);
    const std::uint32_t header[27] = {2, P::end, 0, 16, P::text, 0, 0, 1, 5, P::array, 4, P::triangles, 0, 2, P::joints};
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
