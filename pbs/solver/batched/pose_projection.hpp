// Lines 11-13 of Algorithm 1 for many poses of a mesh side by side: the counterpart of Projection. Poses come in blocks
// of sixteen.
#pragma once

#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"

#include <vector>

namespace pbs {

// The data that all poses share: the constraints in the order of projection.
template <typename Scalar>
struct PoseProgram {
    VertexOrder order;                    // where the mesh's vertices lie
    std::vector<PoseEdge<Scalar>> edges;  // in the order that PbsSolver would take
    std::vector<PoseTet<Scalar>> tets;    // likewise
    std::vector<PoseBind<Scalar>> binds;  // of each vertex; empty: no bind constraints
};

// constraints: with stiffness one wherever any pose has one. jiggle_zone: #V, or empty.
template <typename Scalar>
PoseProgram<Scalar> make_pose_program(const ConstraintSet<Scalar>& constraints, const Tets& tets,
                                      const std::vector<bool>& jiggle_zone);

// A block of poses while it is projected. Lanes without a pose stay at zero.
template <typename Scalar>
class PoseBlock {
public:
    // poses: at most poses_a_block.
    PoseBlock(const PoseProgram<Scalar>& program, const std::vector<PbsOptions>& poses);

    // The same as in Projection, for the pose in one lane.
    void load(int lane, const Positions& p, const Positions& q, const Vec3& origin);
    void store(int lane, const Vec3& origin, Positions& p) const;  // likewise

    void project_bind_constraints();     // line 11, in all lanes
    void project_stretch_constraints();  // line 12
    void project_volume_constraints();   // line 13

private:
    struct alignas(64) Row {  // a coordinate, or a stiffness, of every pose
        Scalar pose[poses_a_block];
    };

    const PoseProgram<Scalar>* program_;
    std::vector<Row> poses_, bind_points_;  // x, y, z of each vertex in the new order [m]
    Row stiffness_[stiffness_classes + 1];  // bind's is the last
};

}  // namespace pbs
