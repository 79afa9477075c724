// The distance of a deformed mesh from a reference on the same vertices. The reference is an array, which may come from
// FEM or from a file.
//   const ErrorMetrics metrics{{mesh.rest, mesh.tets, prescribed, blended, bone_distance_m}};
//   const ErrorNorms error = metrics.measure(positions, reference);
// A norm without anything to measure (no free vertex, no blended vertex) is NaN, and so is one of a frame that is not
// finite.
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
    double l2_pct = 0.0;  // 100 sqrt(sum m_i |x_i - xref_i|^2 / sum m_i) / D; m_i: lumped rest volume, D: diagonal of
                          // the rest bounding box
    // the same root mean square over `blended`, divided by their mean rest distance to the bone (also weighted by m_i)
    double joint_pct = 0.0;
    double linf_m = 0.0;  // max |x_i - xref_i|
};

// Stores the quantities of the domain that the norms need.
class ErrorMetrics {
public:
    // InputError for a mesh that checked_rest_volumes refuses, and for arrays whose sizes do not match.
    explicit ErrorMetrics(const ErrorDomain& domain);
    // both [m], #V x 3, otherwise InputError
    ErrorNorms measure(const pbs::Positions& positions, const pbs::Positions& reference) const;
    // Without the vertices that are left out of this frame, #V; the mean bone distance is that of the remaining
    // vertices.
    ErrorNorms measure(const pbs::Positions& positions, const pbs::Positions& reference,
                       const std::vector<bool>& left_out) const;

    // The share of the body's rest volume at these vertices, #V, in per cent.
    double share_pct(const std::vector<bool>& vertices) const;

private:
    std::vector<int> free_, blended_;  // the vertices that are measured
    Eigen::VectorXd mass_;             // lumped rest volume [m^3], #V
    Eigen::VectorXd bone_distance_m_;  // #V, or empty
    double diagonal_m_ = 0.0;
};

// The smoothness of a deformed body in a region: jumps of strain between neighbouring tets, and bending of the skin
// between neighbouring faces.
//   const SmoothnessMetrics smoothness_metrics(mesh.rest, mesh.tets, near_the_joint);
//   smoothness_metrics.measure(positions).strain_jump_rms;
// Strains are invariant under rotation: a region that turns as a whole is as smooth as at rest.
// Both members are 0 at rest, and for a region without faces or edges to measure.
struct Smoothness {
    // rms over inner faces, weighted by rest area, of |E - E'|, E = (F^T F - 1) / 2 of the tets on both sides (Green),
    // Frobenius norm.
    double strain_jump_rms = 0.0;
    double bending_rms_rad = 0.0;  // rms over the skin's edges, weighted by rest length, of the dihedral angle's change
};

// Stores the quantities of the rest pose that the metrics need.
class SmoothnessMetrics {
public:
    // near: marks the vertices of the region, #V. Faces and edges with all corners in it are measured; without any,
    // both metrics are 0. InputError for a mesh that checked_rest_volumes refuses, and if the number of entries differs
    // from that of the vertices.
    SmoothnessMetrics(const pbs::Positions& rest, const pbs::Tets& tets, const std::vector<bool>& near);
    Smoothness measure(const pbs::Positions& positions) const;  // [m], #V x 3, otherwise InputError

private:
    struct InnerFace {
        int tet, other;
        double area_m2;
    };
    struct SkinEdge {
        int first, second;  // the ends of the edge
        int left, right;    // the vertices opposite to it
        double length_m, angle_rad;
    };
    void find_inner_faces(const std::vector<bool>& near);
    void find_skin_edges(const std::vector<bool>& near);
    Eigen::Matrix3d green_strain(const pbs::Positions& positions, int tet) const;

    pbs::Positions rest_;
    pbs::Tets tets_;
    std::vector<InnerFace> faces_;
    std::vector<SkinEdge> edges_;
};

}  // namespace analysis
