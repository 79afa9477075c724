// The inner loops of the search for self-contact (SelfContact), compiled for the machine (PBS_NATIVE): raw pointers only. x: positions [m];
// an offset is the place of a vertex's first coordinate there. Sixteen boxes, vertices or tets are compared at once: bit k of a result is
// that of lane k.
#pragma once

namespace pbs {

template <typename Scalar>
struct ContactKernels {
    static constexpr int at_once = 16;
    struct Box {
        Scalar low[3], high[3];  // without points it is inverted, and meets no finite one
    };
    struct Boxes {
        Scalar low[3][at_once], high[3][at_once];
    };
    struct Corners {
        int offset[4][at_once];
    };
    // For each tet, the rows of the inverse of its edges (barycentric coordinates 2 to 4) times six volumes, from its first corner.
    struct Coordinates {
        Scalar first[3][at_once], inverse[3][3][at_once], volume[at_once];
    };

    static Box box_of(const int* begin, const int* end, const Scalar* x);
    static Box box_around(const Boxes& boxes);
    static Boxes points_of(const int* begin, const int* end, const Scalar* x);  // the last vertex fills up the lanes
    // Boxes that share a boundary meet. A point that is not a number is in no box.
    static unsigned that_meet(const Boxes& boxes, const Box& box);

    static void find_coordinates(const Corners& corners, const Scalar* x, Coordinates& tets);
    // Tets where the vertex has no negative coordinate, except flat and mirrored ones and its own.
    static unsigned tets_around(const Coordinates& tets, const Corners& corners, int vertex, const Scalar* x);
};

}  // namespace pbs
