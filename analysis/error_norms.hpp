// The distance of a deformed mesh from a reference on the same vertices. The reference is an array, which may come from FEM or from a file.
//   const ErrorNorms error = ErrorMetrics{{mesh.rest, mesh.tets, prescribed, blended, bone_distance_m}}.measure(positions, reference);
// A norm without anything to measure (no free vertex, no blended vertex) is NaN, and so is one of a frame that is not finite.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace analysis {

// The domain on which errors are measured, the same for all frames.
struct ErrorDomain {
    pbs::Positions rest;  // [m], #V x 3
    pbs::Tets tets;       // #T x 4
    // vertices whose positions are prescribed on either side, #V; empty: none. They are left out of every norm
    std::vector<bool> prescribed;
    std::vector<int> blended;         // vertices that Eq. 2 blends between bones; may be empty
    Eigen::VectorXd bone_distance_m;  // rest distance to the bone, #V; may be empty if `blended` is empty
};

// Norms over the vertices that nothing prescribes. A NaN in such a vertex makes every norm that contains it NaN.
struct ErrorNorms {
    double l2_pct = 0.0;  // 100 sqrt(sum m_i |x_i - xref_i|^2 / sum m_i) / D; m_i: lumped rest volume, D: diagonal of the rest bounding box
    // the same root mean square over `blended`, divided by their mean rest distance to the bone (also weighted by m_i)
    double joint_pct = 0.0;
    double linf_m = 0.0;  // max |x_i - xref_i|
};

// Stores the quantities of the domain that the norms need.
class ErrorMetrics {
public:
    // InputError for a mesh that checked_rest_volumes refuses, and for arrays whose sizes do not match.
    explicit ErrorMetrics(const ErrorDomain& domain);
    ErrorNorms measure(const pbs::Positions& positions, const pbs::Positions& reference) const;  // both [m], #V x 3, otherwise InputError
    // Without the vertices that are left out of this frame, #V; the mean bone distance is that of the remaining vertices.
    ErrorNorms measure(const pbs::Positions& positions, const pbs::Positions& reference, const std::vector<bool>& left_out) const;

    // The share of the body's rest volume at these vertices, #V, in per cent.
    double share_pct(const std::vector<bool>& vertices) const;

private:
    std::vector<int> free_, blended_;  // the vertices that are measured
    Eigen::VectorXd mass_;             // lumped rest volume [m^3], #V
    Eigen::VectorXd bone_distance_m_;  // #V, or empty
    double diagonal_m_ = 0.0;
};

// H1 seminorm of the difference: 100 sqrt(sum V0_t |F_t - Fref_t|^2 / sum V0_t), F the deformation gradient of the tet, Frobenius norm.
// InputError for a mesh that checked_rest_volumes refuses, and for frames with another number of points.
double error_h1_pct(const pbs::Positions& rest, const pbs::Tets& tets, const pbs::Positions& positions, const pbs::Positions& reference);

}  // namespace analysis
