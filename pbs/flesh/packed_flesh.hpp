// The packed implementation of FleshSystem: sixteen tets that share no vertex side by side, in the order of memory of the solvers of
// Algorithm 1 (batched/vertex_order.hpp). Threads share the slabs of the mesh; their number changes no bit.
#pragma once

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/vertex_order.hpp"

namespace pbs {

// Energy: FleshEnergy or ProjectiveEnergy. It is read in the constructor alone.
template <typename Scalar, typename Energy>
class PackedSystem : public FleshSystem<Scalar> {
public:
    PackedSystem(const TetMesh& mesh, const Energy& energy, const CholeskyFactor& factor, int threads);

    Rows<Scalar> rows() const override { return Rows<Scalar>(rows_); }
    void set_centres(const Positions& centres) override;
    void load(const Positions& x, Rows<Scalar>& rows) const override;
    void store(const Rows<Scalar>& rows, Positions& x) const override;
    double value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient) override;
    void precondition(Rows<Scalar>& residual) override { solve_.apply(residual.data()); }
    double dot(const Rows<Scalar>& a, const Rows<Scalar>& b) const override { return pbs::dot(a.data(), b.data(), a.size()); }
    void add(double factor, const Rows<Scalar>& a, Rows<Scalar>& to) const override
    {
        pbs::add(Scalar(factor), a.data(), a.size(), to.data());
    }
    std::size_t bytes() const override;
    const std::vector<PackedTets<Scalar, Energy>>& tets() const { return tets_; }  // of each slab

private:
    void fill_slab(int slab, const std::vector<int>& tets, const Energy& energy);

    VertexOrder order_;
    int rows_ = 0;  // of vertices and, behind them, of the dummies of each slab
    Parallel parallel_;
    std::vector<PackedTets<Scalar, Energy>> tets_;
    std::vector<double> slab_energy_;
    Rows<Scalar> centres_;  // c_i - origin, a_i
    Vec3 origin_ = Vec3::Zero();
    TriangularSolve<Scalar> solve_;
};

template <typename Scalar>
using PackedFlesh = PackedSystem<Scalar, FleshEnergy>;
template <typename Scalar>
using PackedProjective = PackedSystem<Scalar, ProjectiveEnergy>;

}  // namespace pbs
