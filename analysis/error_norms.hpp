// How far a deformed mesh is from a reference on the same vertices. The reference is arrays: FEM or a file, the ruler does not ask.
//   const ErrorNorms error = ErrorRuler{{mesh.rest, mesh.tets, prescribed, blended, bone_distance_m}}.measure(positions, reference);
// A figure with nothing to measure on (no free vertex, no blended one) is NaN, as is one of a frame that is not finite.
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace analysis {

// What an error is measured on, the same for all frames.
struct ErrorDomain {
    pbs::Positions rest;              // [m], #V x 3
    pbs::Tets tets;                   // #T x 4
    std::vector<bool> prescribed;     // vertices that either side is told where to be, #V; empty: none. They are left out of every norm
    std::vector<int> blended;         // vertices that Eq. 2 blends between bones; may be empty
    Eigen::VectorXd bone_distance_m;  // rest distance to the bone, #V; may be empty where `blended` is
};

// Over vertices that nothing prescribes; a NaN in one of them makes all that it enters NaN.
struct ErrorNorms {
    double l2_pct = 0.0;  // 100 sqrt(sum m_i |x_i - xref_i|^2 / sum m_i) / D, m_i lumped rest volume, D diagonal of the rest bounding box
    double joint_pct = 0.0;  // the same root mean square over `blended`, over their mean rest distance to the bone (mean by m_i too)
    double linf_m = 0.0;     // max |x_i - xref_i|
};

// Keeps what it needs of the domain.
class ErrorRuler {
public:
    // InputError for a mesh that checked_rest_volumes refuses, and arrays that do not fit it or each other.
    explicit ErrorRuler(const ErrorDomain& domain);
    ErrorNorms measure(const pbs::Positions& positions, const pbs::Positions& reference) const;  // [m], #V x 3 both, else InputError

private:
    std::vector<int> free_, blended_;  // vertices measured on
    Eigen::VectorXd mass_;             // lumped rest volume [m^3], #V
    double diagonal_m_ = 0.0, bone_distance_m_ = 0.0;
};

// H1 seminorm of the difference: 100 sqrt(sum V0_t |F_t - Fref_t|^2 / sum V0_t), F the tet's deformation gradient, Frobenius norm.
// InputError for a mesh that checked_rest_volumes refuses, and frames of another number of points.
double error_h1_pct(const pbs::Positions& rest, const pbs::Tets& tets, const pbs::Positions& positions, const pbs::Positions& reference);

}  // namespace analysis
