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

#include "pbs/skinning/blend.hpp"
#include "pbs/solver/step_summary.hpp"

#include <optional>

namespace pbs {

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

private:
    void predict(const Pose& pose);
    void project(const std::vector<BoneSegment>& bones);
    void update();
    WorkCounters work_of(int iterations) const;
    std::vector<BoneSegment> posed_bones(const Pose& pose) const;

    AuthorOptions options_;
    AuthorStiffness stiffness_;
    Skeleton skeleton_;
    BlendSkinning<double> skinning_;
    std::vector<AuthorGroup> groups_;
    std::optional<Pose> last_pose_;
    Positions lbs_, positions_;           // [m], #V x 3; positions_ are those of the last frame until update
    std::vector<Vector3<double>> x_, v_;  // [m], [m/s], #V
};

}  // namespace pbs
