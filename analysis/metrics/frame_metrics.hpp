// The metrics of one frame, the same for every deformer and for files from other programs.
//   const FrameMetrics metrics = MeshMetrics{mesh.rest, mesh.tets}.measure(positions);
// A frame with positions that are not finite (a numerical breakdown) is measured, not refused: its values are NaN and
// its broken tets count as inverted.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace analysis {

// Neumaier's compensated sum. Its result hardly depends on the order of the terms, and never on the number of threads.
//   CompensatedSum sum;  for (double term : terms) sum += term;  double total = sum.value();
// A. Neumaier, Z. Angew. Math. Mech. 54, 1974.
class CompensatedSum {
public:
    // Adds any double; a term that is not finite makes the sum not finite.
    CompensatedSum& operator+=(double term)
    {
        const double next = sum_ + term;
        lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
        sum_ = next;
        return *this;
    }
    double value() const { return std::isfinite(lost_) ? sum_ + lost_ : sum_; }  // 0 without terms

private:
    double sum_ = 0.0, lost_ = 0.0;
};

// The requirements of every measurement on its rest mesh: indices in range, and a positive volume of every tet.
// The rest volumes [m^3], #T; InputError if the mesh violates a requirement.
Eigen::VectorXd checked_rest_volumes(const pbs::Positions& rest, const pbs::Tets& tets);

// InputError unless `positions` has as many points as the rest mesh.
void require_points(const pbs::Positions& positions, Eigen::Index vertices, const char* name);
// InputError unless there is an entry per vertex.
void require_entries(const std::vector<bool>& marked, Eigen::Index vertices);

// Defined by the signed tet volumes V_t, in double precision and with compensated sums.
struct FrameMetrics {
    double volume_change_pct = 0.0;      // 100 (V - V0) / V0, signed
    double volume_abs_change_pct = 0.0;  // 100 sum |V_t - V0_t| / V0
    int inverted_tets = 0;               // tets with V_t <= 0 or NaN
    double mean_abs_j_minus_1 = 0.0;     // sum V0_t |J_t - 1| / V0, J_t = V_t / V0_t
    double j_min = 0.0;                  // the smallest J_t, negative where a tet is inverted
    double stretch_rms = 0.0;            // rms of l / l0 - 1 over edges
};

// Stores what does not change from frame to frame. InputError for a rest mesh with indices out of range or a tet
// without positive volume, and for a frame with another number of points.
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

// rms of |x_i - q_i| - d_i [m] over all #V; 0 without vertices. InputError if the numbers of bind points and positions
// differ.
double bind_rms(const pbs::Positions& positions, const pbs::Positions& bind_points,
                const Eigen::VectorXd& bind_distance);

// The edge that is stretched or compressed most: largest |l / l0 - 1| over the edges of a tet mesh.
//   double strain = largest_edge_strain(mesh.rest, pbs::edges_of(mesh.tets), positions);
// 0 without edges; NaN if a position is NaN. InputError for a frame with another number of points.
double largest_edge_strain(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions);

// Median over the edges of l / l0. It is near 1 for any deformation of a body, and near a power of ten for a body in
// other units. 1 without edges. InputError as for largest_edge_strain.
double median_edge_ratio(const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions);

// The volume that each region of a body gains or loses. Regions are disjoint sets of tets.
//   const std::vector<RegionVolume> changes = RegionMetrics(mesh.rest, mesh.tets, region_of_tet).measure(positions);
// Computed from signed tet volumes; all members are 0 for a region without tets.
struct RegionVolume {
    double rest_m3 = 0.0;        // sum V0_t
    double change_m3 = 0.0;      // sum V_t - V0_t, signed
    double abs_change_m3 = 0.0;  // sum |V_t - V0_t|
};

// Regions are numbered from 0 to the highest number in use.
class RegionMetrics {
public:
    // region: one entry per tet, #T; 0 or more, or -1 for a tet in no region. InputError unless there is one entry for
    // each tet.
    RegionMetrics(const pbs::Positions& rest, const pbs::Tets& tets, const std::vector<int>& region);

    // one per region; positions [m], #V x 3, not checked
    std::vector<RegionVolume> measure(const pbs::Positions& positions) const;
    double rest_volume_m3() const { return rest_volumes_.sum(); }  // all tets, including those in no region

private:
    pbs::Tets tets_;
    Eigen::VectorXd rest_volumes_;
    std::vector<int> region_;
    std::size_t regions_ = 0;
};

// The volume that a closed triangle surface encloses, and how much of it the render surface embedded in the tets gains
// or loses.
//   const double change_pct = surface_volume_change_pct(rest_points, posed_points, triangles);
// Divergence theorem: the sum of (a x b) . c / 6 over the triangles [m^3], positive when they face outward. InputError
// unless the surface is closed and oriented (each edge occurs equally often in both directions). Where the surface
// crosses itself, parts count by their winding number.
double enclosed_volume(const pbs::Positions& points, const pbs::Triangles& triangles);
// The same sum for any triangles, which are at least one, without a check.
double signed_volume(const pbs::Positions& points, const pbs::Triangles& triangles);

// The surface of many frames: what does not change is checked and measured only once.
class SurfaceVolume {
public:
    SurfaceVolume(const pbs::Positions& rest, const pbs::Triangles& triangles);  // InputError unless V0 is positive
    // 100 (V - V0) / V0; InputError for a different number of points
    double change_pct(const pbs::Positions& posed) const;

private:
    pbs::Triangles triangles_;
    Eigen::Index points_ = 0;
    double rest_volume_ = 0.0;
};

// For the surface of any model: points at the same place at rest are one point, as along texture seams. Empty if the
// surface is open or encloses no positive volume.
std::optional<SurfaceVolume> surface_volume_of(const pbs::Positions& rest, const pbs::Triangles& triangles);

// The same for a single frame.
double surface_volume_change_pct(const pbs::Positions& rest, const pbs::Positions& posed,
                                 const pbs::Triangles& triangles);

}  // namespace analysis
