// The options of PbsSolver and XpbdSolver. Stiffnesses are dimensionless, in [0, 1]; a stiffness of zero leaves the
// class of constraints out.
//   PbsSolver solver(mesh, bind_distance, jiggle_zone, {.iterations = 24, .k_stretch = 0.2});
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <optional>

namespace pbs {

// The shape at which a solver begins a frame, which the caller gives. lbs: linear blend skinning with the character's
// weights, as in the paper. smooth_dqs: dual quaternion skinning with the weights of HeldFlesh::smooth_weights.
enum class StartShape { lbs, smooth_dqs };
// The order of projection within each class of constraints; the classes follow ClassOrder. plain: the order of the
// file, which is how the paper reads. ordered: colour by colour (constraint_sequence.hpp), with sixteen constraints
// side by side that share no vertex. spread: plain code in the order of in_spread_order (constraint_set.hpp), which
// takes less time than the order of the file.
enum class Order { plain, ordered, spread };
// The masses of the particles, of which only the ratios count. unit: m_i = 1, as in the paper. lumped: in proportion to
// the lumped rest volume.
enum class Masses { unit, lumped };
// The form of the volume correction. derived: it follows from Eq. 11. The other forms have one of the errors in print
// of Eq. 12-20, or all of them (pbs/constraints/volume_printed.hpp):
//   labels_relative   Eq. 12-14 under the particles that they are printed for, with positions relative to p1
//   labels_absolute   the same with absolute positions, as printed, so that the correction depends on the origin
//   sign              the derived gradients with the sign that is printed in Eq. 17-20
//   as_printed        labels, absolute positions and sign
enum class VolumeForm { derived, labels_relative, labels_absolute, sign, as_printed };

// The meaning of k. per_iteration: each projection removes the share k of the error, as in the paper. exponent: each
// removes 1 - (1 - k)^(1 / iterations) (M. Mueller et al., Position based dynamics, VRIPHYS 2006), so that a lone
// constraint is left with 1 - k of its error whatever the number of iterations.
enum class StiffnessForm { per_iteration, exponent };

// The order of the classes within an iteration; bind_stretch_volume is that of Algorithm 1 (lines 11-13).
enum class ClassOrder {
    bind_stretch_volume,
    bind_volume_stretch,
    stretch_bind_volume,
    stretch_volume_bind,
    volume_bind_stretch,
    volume_stretch_bind
};

// Where LBS enters Algorithm 1; the paper leaves it open. start: particles outside the jiggling zone start every step
// at their LBS position, those inside are integrated. increment: every particle is integrated, and LBS moves it
// beforehand by what its LBS position has moved since the last step; velocities are relative to that.
enum class LbsEntry { start, increment };

// The bind constraint of a vertex that lies on its bone (d_i = 0). pinned: it draws the vertex to its material point.
// unbound: there is none.
enum class BindOnBone { pinned, unbound };

// The material point q_i that a vertex is bound to ("its projection on the nearest bone", Sec. 3.6). carried: the
// projection at rest, which the bone carries along. reprojected: the projection of the LBS position on the posed bone,
// anew in each step. The caller gives the points to a solver.
enum class BindPoint { carried, reprojected };

// The mean distance from the nearest bone that the vertices of the jiggling zone exceed (Sec. 4). of_all: the mean over
// all vertices. of_bone: the mean over the vertices of their own bone. The caller gives the zone to a solver.
enum class ZoneMean { of_all, of_bone };

// What the bind constraint holds a vertex to. bone_distance: its rest distance from its material point on the bone
// (Sec. 3.6), which leaves the turn about the bone free. blended_position: its position by LBS in this step, at
// distance zero, which resists that turn too. With k_bind = 1 it would undo the other constraints in each iteration, so
// that it needs a small k_bind.
enum class BindTo { bone_distance, blended_position };

// The volumes that are constrained. tets: that of each tet (Sec. 3.5). regions: the sum over each region of about
// region_tets tets (pbs/geometry/tet_mesh.hpp). tets_and_regions: those of the tets, then those of the regions.
enum class VolumeOf { tets, regions, tets_and_regions };

// Stiffnesses of the jiggling zone, in [0, 1]. A zone that a solver is given jiggles only where options have one of
// these.
struct Jiggle {
    double k_stretch = 0.1;             // of edges with both ends in the jiggling zone
    std::optional<double> k_bind = {};  // of the zone's vertices; nothing: as elsewhere
    ZoneMean zone_mean = ZoneMean::of_all;
};

// The paper states 24 iterations and m_i = 1; it leaves k_volume, k_bind, gravity and k_stretch outside the jiggling
// zone unstated. A solver refuses with an InputError: iterations below 0, threads below 1, a stiffness outside [0, 1],
// a negative or NaN stop_residual or sleep_tolerance, sleep without a packed order, a volume_form other than derived
// with a packed one; a k_stretch_length_m that is negative or not finite, region_tets below 1, and volume_of other than
// tets with sleep or with another volume_form than derived.
struct PbsOptions {
    int iterations =
        24;  // at most, of lines 11-13 of Algorithm 1; 0: LBS as it is given (and integrated particles as predicted)
    // Stiffness of edges (k_stretch, Eq. 10), tets (k_volume, Eq. 11) and binds to the bones (k_bind, Sec. 3.6): the
    // share of its error that a projection of a constraint removes (StiffnessForm), in [0, 1].
    double k_stretch = 0.2, k_volume = 1.0, k_bind = 1.0;
    // acts where particles are integrated: in the jiggling zone
    Vec3 gravity_m_s2 = Vec3::Zero();
    Order order = Order::ordered;                  // within each class
    int threads = 1;                               // of a step, where the mesh is large enough for more than one to pay
    Precision precision = Precision::f32;          // of the projections alone
    Masses masses = Masses::unit;                  // the paper's
    VolumeForm volume_form = VolumeForm::derived;  // another one wants order plain, and knows no masses
    StiffnessForm stiffness_form = StiffnessForm::per_iteration;  // as printed
    ClassOrder class_order = ClassOrder::bind_stretch_volume;     // as printed
    LbsEntry lbs_entry = LbsEntry::start;                         // increment: no vertex can be held
    BindOnBone bind_on_bone = BindOnBone::pinned;                 // k_bind applies to it as to any other
    BindPoint bind_point = BindPoint::carried;                    // for the caller, who gives the points
    // A constraint is left out of the frame if LBS satisfies it and all constraints around it within the tolerance. At
    // the end of the frame, those left out are checked, and the frame is repeated with those that are not satisfied any
    // more. The tolerance is one of ratios; for bind constraints it is a share of the mean edge.
    bool sleep = false;
    double sleep_tolerance = 1e-3;  // 0 or more, dimensionless; see sleep
    double stop_residual =
        0.0;  // stop when the largest of the three residuals is below, else not_converged; 0: all iterations
    bool record_iterations = false;  // keep residuals of every iteration
    std::optional<Jiggle> jiggle;    // nothing: the zone is as all else

    // Changes to the paper's method; the defaults are the paper's.
    StartShape start = StartShape::lbs;  // for the caller
    BindTo bind_to = BindTo::bone_distance;
    VolumeOf volume_of = VolumeOf::tets;
    int region_tets = 256;  // tets in a region, 1 or more; see volume_of
    // The edge length at which a stretch constraint has the stiffness k as stated [m]; others have that of
    // stiffness_at_length (constraint_set.hpp). 0: all have k.
    double k_stretch_length_m = 0.0;
    // Skin that lies in flesh of another part is pushed out of it, by a constraint per such vertex that follows the
    // volume constraints of each iteration (SelfContact). Not for many poses at once.
    bool contact = false;
};

// XpbdSolver (extended position based dynamics, XPBD) has these options. It refuses with an InputError: poisson outside
// [1/4, 1/2), substeps below 1, threads below 1.
struct XpbdOptions {
    double young_pa = 1.0e5;
    double poisson = 0.45;  // at least 1/4, which springs alone have; volume constraints raise it
    double density_kg_m3 = 1000.0;
    int iterations = 24;  // per substep
    int substeps = 1;     // per time step
    Vec3 gravity_m_s2 = Vec3::Zero();
    StartShape start = StartShape::lbs;  // for the caller
    bool jiggle = false;                 // the jiggling zone is integrated in time
    bool keep_multipliers = true;        // false: set to zero in every iteration, a common mistake; a negative control
    Order order = Order::plain;          // within each class; ordered is packed code
    Precision precision = Precision::f64;  // of the projections and their multipliers
    int threads = 1;  // of a step in packed code, where the mesh is large enough for more than one to pay
};

}  // namespace pbs
