// The metrics of one frame, the same for every deformer and for files from other programs.
//   const FrameMetrics metrics = MeshMetrics{mesh.rest, mesh.tets}.measure(positions);
// A frame with positions that are not finite (a numerical breakdown) is measured, not refused: its values are NaN and its broken tets count
// as inverted.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace analysis {

// Defined by the signed tet volumes V_t, in double precision and with compensated sums.
struct FrameMetrics {
    double volume_change_pct = 0.0;      // 100 (V - V0) / V0, signed
    double volume_abs_change_pct = 0.0;  // 100 sum |V_t - V0_t| / V0
    int inverted_tets = 0;               // tets with V_t <= 0 or NaN
    double mean_abs_j_minus_1 = 0.0;     // sum V0_t |J_t - 1| / V0, J_t = V_t / V0_t
    double j_min = 0.0;                  // the smallest J_t, negative where a tet is inverted
    double stretch_rms = 0.0;            // rms of l / l0 - 1 over edges
};

// Stores what does not change from frame to frame. InputError for a rest mesh with indices out of range or a tet without positive volume,
// and for a frame with another number of points.
class MeshMetrics {
public:
    MeshMetrics(const pbs::Positions& rest, const pbs::Tets& tets);        // [m], #V x 3; #T x 4
    FrameMetrics measure(const pbs::Positions& positions) const;           // [m], #V x 3
    Eigen::VectorXd volume_ratios(const pbs::Positions& positions) const;  // J_t, #T

private:
    double stretch_rms(const pbs::Positions& positions) const;

    pbs::Tets tets_;
    Eigen::VectorXd rest_volumes_;
    pbs::Edges edges_;
    Eigen::VectorXd rest_lengths_;
    double rest_volume_ = 0.0;
    Eigen::Index vertices_ = 0;
};

// rms of |x_i - q_i| - d_i [m] over all #V; 0 without vertices. InputError if the numbers of bind points and positions differ.
double bind_rms(const pbs::Positions& positions, const pbs::Positions& bind_points, const Eigen::VectorXd& bind_distance);

}  // namespace analysis
