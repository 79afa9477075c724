// Position based skinning as in the code that the paper's first author published in 2018: GitHub, NadineAB/Radium-Engine, branch PBS,
// commit f7101809, folder Plugins/Skinning/src/PositionBasedSkinning. It is not the program of the paper, but it is the author's own
// reading of it. Written anew from a description of what that code does.
//   AuthorSolver solver(mesh, skeleton, bind_to_nearest_bone(mesh.rest, skeleton), options);
//   solver.advance(pose);   // every frame
//   solver.positions();
//
// Where it departs from the paper, `pbskin explain pbs_author` lists. In short: every particle starts every frame at its LBS position and
// is integrated with the displacement of the last frame as its velocity, so that motion counts twice; the volume gradients lack 1/6; binds
// search the posed bone anew, with half the correction; one colouring of all constraints determines the order.
//
// Two details are left out. That code scales the tets by 1.1 on reading and back, which changes nothing except roundings. It computes in
// float, this file in double.
#pragma once

#include "pbs/author/author_constraints.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/weights.hpp"
#include "pbs/solver/step_summary.hpp"

#include <optional>

namespace pbs {

// The order of projection in the code published by the paper's first author. Its constraints are listed as volume by
// tet, bind by vertex, and stretch by edge. Each one joins the first group in which no constraint of any kind has one of its vertices. The
// groups are projected in turn; within a group the order does not matter, to the bit.
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

// The defaults are those of that code, with two exceptions. It has gravity (0, -9.81, 0) in its unit of length, which moves every particle
// by g h^2 = 98 mm a step in metres; here gravity is off, as in the scenes of this project. It leaves the unit of length open; here it is a
// centimetre, for in metres its threshold leaves out every tet of less than some 3 cm.
struct AuthorOptions {
    int iterations = 12;               // per frame; the paper has 24
    double time_step_s = 0.1;          // h, whatever the frame rate; it cancels where there is no gravity
    Vec3 gravity_m_s2 = Vec3::Zero();  // acts on every particle
    double length_unit_m = 0.01;       // metres per unit of length of smallest_gradient2
    double k_compression = 1.0;        // of lengths below their rest length, in [0, 1]
    double k_stretch = 1.0;            // of all other lengths, in [0, 1]
    double k_volume_inverted = 1.0;    // of tets with negative volume, in [0, 6]
    double k_volume = 1.0;             // of all other tets, in [0, 6]; 1 removes a sixth of a volume's error, 6 all of it
};

class AuthorSolver {
public:
    // mesh: indices in range (unchecked). binding: of its vertices to this skeleton. InputError for options out of their range, and for a
    // binding of another number of vertices.
    AuthorSolver(const TetMesh& mesh, const Skeleton& skeleton, const BoneBinding& binding, const AuthorOptions& options);

    // One frame. A pose that equals the last one, to the bit, is not stepped: the flesh stops when the character stops. pose: every bone of
    // the skeleton (unchecked).
    StepSummary advance(const Pose& pose);

    const Positions& positions() const { return positions_; }  // [m], #V x 3; the rest positions before the first step
    const std::vector<AuthorGroup>& groups() const { return groups_; }

    // The parts of a step: advance() predicts, projects as often as there are iterations, and updates positions() and the velocities.
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
// paper_weights (pbs/skinning/weights.hpp) differ where siblings start at the same head, and where a child starts elsewhere than at the
// tail of its parent.

// `binding` must belong to this skeleton (unchecked). A vertex with 1/6 <= t <= 5/6, or near the head of a root, has its bone alone.
Weights author_weights(const BoneBinding& binding, const Skeleton& skeleton);

}  // namespace pbs
