// This measures what people see, the distance of a deformed skin from a reference, in the units of papers on skinning;
// error_norms.hpp measures the flesh.
//   const SkinError error = SkinErrorMetrics{mesh.rest, mesh.tets}.measure(positions, reference);
// The root mean square over the skin in per cent of the bounding box's diagonal is that of L. Kavan, P.-P. Sloan, C.
// O'Sullivan (Computer Graphics Forum 29, 2010) and of B. H. Le, Z. Deng (ACM Transactions on Graphics 33, 2014).
// Millimetres are those of the body where the largest extent of its skin at rest is 1.7 m, which is its height or its
// span, so that bodies of different sizes compare.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace analysis {

// All are weighted by the skin's area at rest. All are 0 for the reference itself, unless a triangle has lost its area
// in it; and NaN where a position of the skin is not finite.
struct SkinError {
    double rms_mm = 0.0, p95_mm = 0.0, largest_mm = 0.0;  // of |x_i - xref_i|
    double rms_pct = 0.0;                                 // of the diagonal of the rest skin's bounding box
    // The angle is the one between the normals of a triangle and of the same triangle in the reference. It is 180
    // degrees where the area of one of them is below 1e-12 of that at rest.
    double normals_mean_deg = 0.0, normals_p95_deg = 0.0;
};

// The share of the error of one shape that another shape removes, in per cent; below 0 where it adds to it; NaN where
// there is no error to be removed.
double removed_share_pct(double error, double of_other);

// Stores the skin of a body: the boundary of its tets.
class SkinErrorMetrics {
public:
    // rest [m], #V x 3; tets #T x 4. InputError for a mesh that checked_rest_volumes refuses.
    SkinErrorMetrics(const pbs::Positions& rest, const pbs::Tets& tets);

    // Positions of all vertices [m], #V x 3, otherwise InputError. Vertices that are left out, #V, and the triangles
    // with one of them do not count; without any left, all members are NaN.
    SkinError measure(const pbs::Positions& positions, const pbs::Positions& reference,
                      const std::vector<bool>& left_out) const;

private:
    pbs::Triangles skin_;
    Eigen::VectorXd area_m2_;         // of each triangle at rest
    Eigen::VectorXd vertex_area_m2_;  // a third of those of its triangles, #V; 0 inside the body
    double diagonal_m_ = 0.0, extent_m_ = 0.0;
};

// The smallest value that at least `share` of the weight does not exceed, 0 < share < 1; NaN without weight or where a
// value is NaN.
//   weighted_quantile({1.0, 2.0, 3.0}, {1.0, 1.0, 2.0}, 0.5) == 2.0
double weighted_quantile(const std::vector<double>& values, const std::vector<double>& weights, double share);

}  // namespace analysis
