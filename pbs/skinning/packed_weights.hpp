// Skinning weights as the blend kernels read them: which vertices need no blending of their own, and the rows of the others.
#pragma once

#include "pbs/skinning/weights.hpp"

namespace pbs {

// A bone's dual quaternion on the side of the pivot's: q and -q are the same rotation, and the heaviest bone of a row decides.
struct TurnedBone {
    // Index of the bone that is blended.
    int bone, pivot;                                     // index of the row's heaviest bone, the first of equals
    bool operator==(const TurnedBone&) const = default;  // of both
};

// Rows of weights, sparse in bones: row i has the entries first[i] <= k < first[i + 1]. Weights of zero are left out.
template <class Scalar>
struct WeightRows {
    std::vector<int> first = {0};  // #rows + 1
    std::vector<int> bone;         // #entries
    std::vector<int> turned_bone;  // index into PackedWeights::turned_bones, #entries
    std::vector<Scalar> weight;    // #entries

    int rows() const { return static_cast<int>(first.size()) - 1; }  // 0 of default-made rows
};

// Consecutive vertices that are moved in one loop.
struct VertexStretch {
    // one_matrix: all by the same; matrix_each: by PackedWeights::matrix of each; own_rows: blended one by one.
    enum class Kind { one_matrix, matrix_each, own_rows };
    Kind kind;  // of all its vertices
    // Index of the first vertex.
    int first, last;  // one behind the last vertex
    int own_row;      // the first one's row of PackedWeights::own
};

// Weights of #V vertices. Scalar: float or double.
template <class Scalar>
struct PackedWeights {
    int bones = 0;                         // the largest bone that has a vertex, and one
    WeightRows<Scalar> shared;             // blended once a pose: rows that several vertices have (Eq. 2 knows few)
    WeightRows<Scalar> own;                // rows of one vertex alone, in the order of the vertices
    std::vector<int> matrix;               // of a vertex: its only bone, or bones + a shared row; -1: blended by a row of its own, #V
    std::vector<VertexStretch> stretches;  // all vertices, in order
    std::vector<TurnedBone> turned_bones;  // each one that a row uses, listed once
};

// Every vertex has at least one weight that is not zero (unchecked).
template <class Scalar>
PackedWeights<Scalar> pack_weights(const Weights& weights);

}  // namespace pbs
