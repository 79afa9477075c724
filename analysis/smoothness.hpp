// The smoothness of a deformed body in a region: jumps of strain between neighbouring tets, and bending of the skin between neighbouring
// faces.
//   const SmoothnessMetrics smoothness_metrics(mesh.rest, mesh.tets, near_the_joint);
//   smoothness_metrics.measure(positions).strain_jump_rms;
// Strains are invariant under rotation: a region that turns as a whole is as smooth as at rest.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace analysis {

// Both members are 0 at rest, and for a region without faces or edges to measure.
struct Smoothness {
    // rms over inner faces, weighted by rest area, of |E - E'|, E = (F^T F - 1) / 2 of the tets on both sides (Green), Frobenius norm.
    double strain_jump_rms = 0.0;
    double bending_rms_rad = 0.0;  // rms over the skin's edges, weighted by rest length, of the dihedral angle's change
};

// Stores the quantities of the rest pose that the metrics need.
class SmoothnessMetrics {
public:
    // near: marks the vertices of the region, #V. Faces and edges with all corners in it are measured; without any, both metrics are 0.
    // InputError for a mesh that checked_rest_volumes refuses, and if the number of entries differs from that of the vertices.
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
