// Inner loops of the blends on raw arrays, compiled for the present machine; blend.hpp calls them. Scalar is float or
// double.
//   rest, posed: points [m], n x 3, that do not overlap; one number behind the last rest point is read as well, and not
//   used
#pragma once

namespace pbs {

// v' = c_0 x + c_1 y + c_2 z + t: the columns c_0, c_1, c_2, t of a rigid or blended transform, padded to four numbers
// each.
template <class Scalar>
struct alignas(64) PaddedMatrix {
    Scalar numbers[16];  // column by column; the fourth of each is not used
};

// Real and dual part as x, y, z, w.
template <class Scalar>
struct alignas(8 * sizeof(Scalar)) PackedDualQuaternion {
    Scalar numbers[8];  // real x, y, z, w, then dual
};

// n rows of weights, sparse in bones: row i blends the transforms `transform[k]` with `weight[k]`, first[i] <= k <
// first[i + 1].
template <class Scalar>
struct BlendRows {
    int n;                 // 0 or more
    const int* first;      // n + 1
    const int* transform;  // #entries
    const Scalar* weight;  // #entries
};

// No blending: all points by one matrix, or point i by matrix transform[i].
template <class Scalar>
void transform_points(int n, const PaddedMatrix<Scalar>& matrix, const Scalar* rest, Scalar* posed);
// Every point has its own matrix.
template <class Scalar>
void transform_points(int n, const int* transform, const PaddedMatrix<Scalar>* matrices, const Scalar* rest,
                      Scalar* posed);

// Every point has its own row of weights.
template <class Scalar>
void blend_points(const BlendRows<Scalar>& rows, const PaddedMatrix<Scalar>* matrices, const Scalar* rest,
                  Scalar* posed);
// The same for dual quaternions, each with the sign that agrees with the heaviest of its row (TurnedBone).
template <class Scalar>
void blend_points(const BlendRows<Scalar>& rows, const PackedDualQuaternion<Scalar>* dual_quaternions,
                  const Scalar* rest, Scalar* posed);

// The blended transforms themselves, one per row.
template <class Scalar>
void blend_matrices(const BlendRows<Scalar>& rows, const PaddedMatrix<Scalar>* matrices, PaddedMatrix<Scalar>* blended);
// The same for dual quaternions; the results are rigid.
template <class Scalar>
void blend_matrices(const BlendRows<Scalar>& rows, const PackedDualQuaternion<Scalar>* dual_quaternions,
                    PaddedMatrix<Scalar>* blended);

// Inner loops of delta mush and direct delta mush on raw arrays, compiled for the present machine; delta_mush.hpp and
// direct_delta_mush.hpp call them. Scalar is float or double. Points are rows x, y, z, 0 [m], relative to any origin
// near the body.

// The neighbours of vertex i are neighbour[k], first[i] <= k < first[i + 1].
template <class Scalar>
struct NeighbourRows {
    int n;                   // vertices, 0 or more
    const int* first;        // n + 1
    const int* neighbour;    // #entries
    const Scalar* one_over;  // the number of neighbours; zero: there is none, n
};

// Vertices whose covariance the formulae for the nearest rotation refuse (rotation_formula.hpp). The caller decomposes
// it and moves them.
template <class Scalar>
struct RefusedRotations {
    int n = 0;
    int* vertex;              // room for every vertex
    Scalar (*covariance)[9];  // from row to row, as many
};

// One step of Laplacian smoothing: each point goes the share `step` of the way to the mean of its neighbours.
template <class Scalar>
void smooth_points(const NeighbourRows<Scalar>& rows, Scalar step, const Scalar* from, Scalar* to);

// A shape at rest and posed, whose edges count with a share in the frames; share 0: the pointers are not read.
template <class Scalar>
struct EdgeRows {
    const Scalar* rest;
    const Scalar* posed;
    Scalar share;
};

// posed = smooth + R detail, R being the rotation that best maps the edges at rest to the posed ones, of the smoothed
// shape (share 1) and of the unsmoothed one. Refused vertices get posed = smooth. posed: n rows of x, y, z.
template <class Scalar>
void add_detail(const NeighbourRows<Scalar>& rows, const EdgeRows<Scalar>& smooth, const EdgeRows<Scalar>& unsmoothed,
                const Scalar* detail, Scalar* posed, RefusedRotations<Scalar>& refused);

// The moments of the rest shape about a vertex's own centre that direct delta mush has precomputed for this vertex and
// a bone.
template <class Scalar>
struct BoneMoments {
    Scalar second[6];  // xx, xy, xz, yy, yz, zz [m^2]
    Scalar first[3];   // x, y, z [m]
    Scalar share[3];   // first moment times 1 - alpha [m]
    Scalar weight;     // of the bone
    int bone;          // index of its matrix
};

// The entries of vertex i are moments[k], first[i] <= k < first[i + 1], at least one.
template <class Scalar>
struct MomentRows {
    int n;                               // vertices, 0 or more
    const int* first;                    // n + 1
    const BoneMoments<Scalar>* moments;  // #entries
    const Scalar* centre;                // n rows x, y, z, 1
    const Scalar* detail;                // rest position - centre, n rows x, y, z, 0
};

// posed = q + R detail, with the blended centre q and the rotation R of direct_delta_mush.hpp. Refused vertices get
// posed = q. posed: n rows of x, y, z.
template <class Scalar>
void move_by_moments(const MomentRows<Scalar>& rows, const PaddedMatrix<Scalar>* bones, Scalar* posed,
                     RefusedRotations<Scalar>& refused);

}  // namespace pbs
