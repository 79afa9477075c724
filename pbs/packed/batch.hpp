// Sixteen constraints that share no vertex, side by side: the input of the kernels. Plain data, for builders and
// kernels alike. ContactKernels declares the kernels of the search for self-contact, which code without batches uses as
// well.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

namespace pbs {

// Constraints in a batch; on machines of fewer lanes it is worked off in parts, so that the order of projection is the
// same everywhere.
inline constexpr int batch_size = 16;

// A stretch constraint joins the two vertices of an edge, a volume constraint the four of a tet.
enum class ConstraintKind { edge, tet };
constexpr int corners(ConstraintKind kind)
{
    return kind == ConstraintKind::edge ? 2 : 4;
}

// Every constraint [lane] of a batch. rest: rest length [m] of an edge, six times the rest volume [m^3] of a tet;
// stiffness: k, of an edge over w1 + w2; zero for a constraint that is not there.
template <typename Scalar, ConstraintKind kind>
struct alignas(64) Batch {
    std::uint32_t offset[corners(kind)][batch_size];  // 4 * vertex
    Scalar rest[batch_size];                          // l0, or 6 V0
    Scalar stiffness[batch_size];                     // k / (w1 + w2), or k
};

// The bind constraints of sixteen vertices that follow each other.
template <typename Scalar>
struct alignas(64) BindBatch {
    Scalar x[batch_size], y[batch_size], z[batch_size];  // q_i [m]
    Scalar rest_distance[batch_size];                    // d_i [m]
    Scalar stiffness[batch_size];                        // zero where the vertex is pinned or has no bind constraint
};

// The inner loops of the search for self-contact (SelfContact), in a source that is compiled for the machine
// (PBS_NATIVE). They take raw pointers only. x: an array of Point; an offset is the place of a point's first coordinate
// there, 4 * vertex. Sixteen boxes, vertices or tets are compared at once: bit k of a result is that of lane k.
template <typename Scalar>
struct ContactKernels {
    static constexpr int at_once = batch_size;
    struct alignas(4 * sizeof(Scalar)) Point {
        Scalar x[4];  // [m]; the last one is loaded with the others and not used
    };
    struct Box {
        Scalar low[3], high[3];  // without points it is inverted, and meets no finite one
    };
    struct alignas(64) Boxes {
        Scalar low[3][at_once], high[3][at_once];
    };
    struct alignas(64) Corners {
        std::uint32_t offset[4][at_once];
    };
    // For each tet, the rows of the inverse of its edges (barycentric coordinates 2 to 4) times six volumes, from its
    // first corner.
    struct alignas(64) Coordinates {
        Scalar first[3][at_once], inverse[3][3][at_once], volume[at_once];
    };

    static Box box_of(const std::uint32_t* begin, const std::uint32_t* end, const Scalar* x);
    static Box box_around(const Boxes& boxes);
    // Each point becomes a box without extent. The other lanes are NaN. What is not a number meets no box.
    static void find_points(const std::uint32_t* begin, const std::uint32_t* end, const Scalar* x, Boxes& points);
    static unsigned that_meet(const Boxes& boxes, const Box& box);  // boxes that share a boundary do

    static void find_coordinates(const Corners& corners, const Scalar* x, Coordinates& tets);
    // Finds the tets in which the vertex at each offset has no negative barycentric coordinate. It leaves out flat and
    // mirrored tets and those of the vertex itself.
    static void find_tets_around(const Coordinates& tets, const Corners& corners, const std::uint32_t* begin,
                                 const std::uint32_t* end, const Scalar* x, unsigned* bits);
};

// Calls f with a std::integral_constant of the kind.
template <typename F>
constexpr decltype(auto) with_kind(ConstraintKind kind, F&& f)
{
    if (kind == ConstraintKind::edge) return f(std::integral_constant<ConstraintKind, ConstraintKind::edge>());
    return f(std::integral_constant<ConstraintKind, ConstraintKind::tet>());
}

}  // namespace pbs
