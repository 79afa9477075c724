// Position based skinning as in the code that the paper's first author published in 2018: GitHub,
// NadineAB/Radium-Engine, branch PBS, commit f7101809, folder Plugins/Skinning/src/PositionBasedSkinning. It is not the
// program of the paper, but it is the author's own reading of it. This file is written anew from a description of what
// that code does.
//   AuthorSolver solver(mesh, skeleton, bind_to_nearest_bone(mesh.rest, skeleton), options);
//   solver.advance(pose);   // every frame
//   solver.positions();
//
// `pbskin explain pbs_author` lists where it departs from the paper. In short: every particle starts every frame at
// its LBS position and is integrated with the displacement of the last frame as its velocity, so that motion counts
// twice; the volume gradients lack 1/6; binds search the posed bone anew, with half the correction; one colouring of
// all constraints determines the order.
//
// Two details are left out. That code scales the tets by 1.1 on reading and back, which changes nothing except
// roundings. It computes in float, this file in double.
#pragma once

#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/weights.hpp"
#include "pbs/solver/step_summary.hpp"

#include <algorithm>
#include <optional>

namespace pbs {

// The constraints of that code: value, gradient, multiplier, correction. All masses are one. Each projection departs
// from the paper's, or from that of pbs/constraints, in what its comment names.
//   project(AuthorVolume{{0, 1, 2, 3}, rest_volume}, stiffness, x);
// x: positions [m], #V.

// The sum of squared volume gradients [unit^4] below which that code leaves a tet out. It depends on the unit of
// length.
inline constexpr double smallest_gradient2 = 1e-6;

struct AuthorStiffness {
    double compression, stretch;     // of lengths below their rest length, and of all others
    double volume_inverted, volume;  // of tets with negative volume, and of all others
    double smallest_gradient2_m4;    // smallest_gradient2 in metres
};

struct AuthorVolume {
    std::array<int, 4> vertex;
    double rest_volume;  // V0 [m^3], absolute
};

struct AuthorStretch {
    std::array<int, 2> vertex;
    double rest_length;  // d [m]
};

struct AuthorBind {
    int vertex, bone;
    double distance;  // d_i [m], from the bone at rest
};

// A posed bone [m].
struct BoneSegment {
    Vector3<double> head, tail;
};

inline double length_stiffness(double C, const AuthorStiffness& k)
{
    return C < 0.0 ? k.compression : k.stretch;
}

// The point of a bone nearest to p; the head of a bone without length.
inline Vector3<double> nearest_point(const BoneSegment& bone, const Vector3<double>& p)
{
    const Vector3<double> axis = bone.tail - bone.head;
    const double length2 = axis.squaredNorm();
    if (!(length2 > 0.0)) return bone.head;
    return bone.head + std::clamp((p - bone.head).dot(axis) / length2, 0.0, 1.0) * axis;
}

// C is Eq. 11, but the gradients lack its 1/6. So lambda is a sixth of what Eq. 21 gives with the gradients of Eq. 11,
// and with k = 1 five sixths of C remain to first order.
inline void project(const AuthorVolume& constraint, const AuthorStiffness& k, std::vector<Vector3<double>>& x)
{
    auto &p1 = x[constraint.vertex[0]], &p2 = x[constraint.vertex[1]], &p3 = x[constraint.vertex[2]],
         &p4 = x[constraint.vertex[3]];
    const Vector3<double> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const double volume = sixth<double> * p21.cross(p31).dot(p41);
    const double C = volume - constraint.rest_volume;
    const Vector3<double> g2 = p31.cross(p41), g3 = p41.cross(p21), g4 = p21.cross(p31), g1 = -(g2 + g3 + g4);
    const double gradient2 = g1.squaredNorm() + g2.squaredNorm() + g3.squaredNorm() + g4.squaredNorm();
    if (!(gradient2 >= k.smallest_gradient2_m4) || !(gradient2 > 0.0)) return;
    const double lambda = (volume < 0.0 ? k.volume_inverted : k.volume) * C / gradient2;
    p1 -= lambda * g1;
    p2 -= lambda * g2;
    p3 -= lambda * g3;
    p4 -= lambda * g4;
}

// The posed bone is searched for its nearest point in every projection, where the paper has a point that moves with the
// bone. The correction has the factor 1/2, as if the bone were a second free particle. A vertex on its bone has no
// direction and stays.
inline void project(const AuthorBind& constraint, const std::vector<BoneSegment>& bones, const AuthorStiffness& k,
                    std::vector<Vector3<double>>& x)
{
    Vector3<double>& p = x[constraint.vertex];
    const Vector3<double> to_bone = nearest_point(bones[constraint.bone], p) - p;
    const double length = to_bone.norm();
    if (!(length > 0.0)) return;
    const double C = length - constraint.distance;
    p += 0.5 * length_stiffness(C, k) * C / length * to_bone;
}

// Eq. 8-10 with k by the sign of C. An edge without length has no direction and stays; that code does not test for it.
inline void project(const AuthorStretch& constraint, const AuthorStiffness& k, std::vector<Vector3<double>>& x)
{
    auto &p1 = x[constraint.vertex[0]], &p2 = x[constraint.vertex[1]];
    const Vector3<double> p21 = p2 - p1;
    const double length = p21.norm();
    if (!(length > 0.0)) return;
    const double C = length - constraint.rest_length;
    const Vector3<double> correction = 0.5 * length_stiffness(C, k) * C / length * p21;
    p1 += correction;
    p2 -= correction;
}

// The order of projection in the code published by the paper's first author. Its constraints are listed as volume by
// tet, bind by vertex, and stretch by edge. Each one joins the first group in which no constraint of any kind has one
// of its vertices. The groups are projected in turn; within a group the order does not matter, to the bit.
//   for (const AuthorGroup& group : author_groups(mesh, binding)) project_all(group);

// Constraints that share no vertex.
struct AuthorGroup {
    std::vector<AuthorVolume> volume;
    std::vector<AuthorBind> bind;
    std::vector<AuthorStretch> stretch;
};

// Each edge once, as it first appears when the tets list theirs as 01, 02, 03, 12, 13, 23, #E x 2.
Edges edges_by_appearance(const Tets& tets);

// mesh: indices in range (unchecked). binding: of its vertices.
std::vector<AuthorGroup> author_groups(const TetMesh& mesh, const BoneBinding& binding);

// The defaults are those of that code, with two exceptions. It has gravity (0, -9.81, 0) in its unit of length, which
// moves every particle by g h^2 = 98 mm a step in metres; here gravity is off, as in the scenes of this project. It
// leaves the unit of length open; here it is a centimetre, for in metres its threshold leaves out every tet of less
// than some 3 cm.
struct AuthorOptions {
    int iterations = 12;               // per frame; the paper has 24
    double time_step_s = 0.1;          // h, whatever the frame rate; it cancels where there is no gravity
    Vec3 gravity_m_s2 = Vec3::Zero();  // acts on every particle
    double length_unit_m = 0.01;       // metres per unit of length of smallest_gradient2
    double k_compression = 1.0;        // of lengths below their rest length, in [0, 1]
    double k_stretch = 1.0;            // of all other lengths, in [0, 1]
    double k_volume_inverted = 1.0;    // of tets with negative volume, in [0, 6]
    double k_volume = 1.0;  // of all other tets, in [0, 6]; 1 removes a sixth of a volume's error, 6 all of it
};

class AuthorSolver {
public:
    // mesh: indices in range (unchecked). binding: of its vertices to this skeleton. InputError for options out of
    // their range, and for a binding of another number of vertices.
    AuthorSolver(const TetMesh& mesh, const Skeleton& skeleton, const BoneBinding& binding,
                 const AuthorOptions& options);

    // One frame. A pose that equals the last one, to the bit, is not stepped: the flesh stops when the character stops.
    // pose: every bone of the skeleton (unchecked).
    StepSummary advance(const Pose& pose);

    const Positions& positions() const { return positions_; }  // [m], #V x 3; the rest positions before the first step
    const std::vector<AuthorGroup>& groups() const { return groups_; }

    // The parts of a step: advance() predicts, projects as often as there are iterations, and updates positions() and
    // the velocities.
    void predict(const Pose& pose);
    void project(const std::vector<BoneSegment>& bones);
    void update();
    std::vector<BoneSegment> posed_bones(const Pose& pose) const;

private:
    WorkCounters work_of(int iterations) const;

    AuthorOptions options_;
    AuthorStiffness stiffness_;
    Skeleton skeleton_;
    BlendSkinning<double> skinning_;
    std::vector<AuthorGroup> groups_;
    std::optional<Pose> last_pose_;
    Positions lbs_, positions_;           // [m], #V x 3; positions_ are those of the last frame until update
    std::vector<Vector3<double>> x_, v_;  // [m], [m/s], #V
};

// The weights of Eq. 2 as the code published by the paper's first author reads them. Eq. 2 leaves n_joints open: at the
// head of a bone that code counts the bone and its parent, at the tail the bone and all of its children.
//   const Weights weights = author_weights(binding, skeleton);
// paper_weights (pbs/skinning/weights.hpp) differ where siblings start at the same head, and where a child starts
// elsewhere than at the tail of its parent.

// `binding` must belong to this skeleton (unchecked). A vertex with 1/6 <= t <= 5/6, or near the head of a root, has
// its bone alone.
Weights author_weights(const BoneBinding& binding, const Skeleton& skeleton);

}  // namespace pbs
