// The packed implementation of XpbdSystem: sixteen tets that share no vertex side by side, in the order of memory of the solvers of
// Algorithm 1 (batched/vertex_order.hpp). In each slab of the mesh, first the springs and then the tets are visited. Threads share the
// slabs; their number changes no bit.
#pragma once

#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "pbs/packed/groups.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/vertex_order.hpp"

namespace pbs {

template <typename Scalar>
class PackedXpbd : public XpbdSystem<Scalar> {
public:
    PackedXpbd(const TetMesh& mesh, const XpbdFlesh& flesh, int threads);

    Rows<Scalar> rows() const override;
    void set_targets(const Positions& targets) override;
    void load(const Positions& x, Rows<Scalar>& rows) const override;
    void store(const Rows<Scalar>& rows, Positions& x) const override;
    void forget() override;
    void iterate(Rows<Scalar>& x, bool with_residual) override;
    std::vector<XpbdVisit> visits() const override;

private:
    using Members = std::vector<std::vector<int>>;  // tets of each batch
    struct Slab {
        Members hold_members, tet_members;
        std::vector<HoldBatch<Scalar>> holds;
        std::vector<NeoHookeanBatch<Scalar>> tets;
    };
    struct ModePlace {
        int slab, batch, mode, lane;
    };

    void fill_slab(int slab, const std::vector<int>& tets, const XpbdFlesh& flesh);
    Members scheduled(BatchScheduler& scheduler, const std::vector<int>& tets, const XpbdFlesh& flesh) const;
    template <typename Batch>
    void set_offsets(Batch& batch, int lane, int slab, const NeoHookeanTet* tet) const;
    void fill_hold(HoldBatch<Scalar>& batch, int lane, int tet, const XpbdFlesh& flesh);
    void fill_tet(NeoHookeanBatch<Scalar>& batch, int lane, int tet, const XpbdFlesh& flesh);

    VertexOrder order_;
    int rows_ = 0;  // of vertices and, behind them, of the dummies of each slab
    Parallel parallel_;
    Eigen::VectorXd w_;
    Scalar alpha_;
    std::vector<Slab> slabs_;
    std::vector<ModePlace> place_;  // of each mode
    Vec3 origin_ = Vec3::Zero();
};

}  // namespace pbs
