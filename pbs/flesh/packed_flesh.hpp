// The packed implementation of FleshSystem: sixteen tets that share no vertex side by side, in the order of memory of the solvers of
// Algorithm 1 (batched/vertex_order.hpp). Threads share the slabs of the mesh; their number changes no bit.
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/vertex_order.hpp"

#include <array>
#include <vector>

namespace pbs {

// The tets of one slab, sixteen side by side, as PackedSystem (packed_flesh.hpp) needs them: one specialisation for each energy.
//   PackedTets<float, FleshEnergy> tets(energy);
//   tets.add_batch();
//   tets.set_tet(lane, t, offset);        // tet t of the energy in the last batch
//   tets.set_dummy(lane, offset);         // a lane without a tet
//   double e = tets.add_gradient(x, gradient);
using TetOffsets = std::array<std::uint32_t, 4>;  // 4 * row of each vertex

template <typename Scalar, typename Energy>
class PackedTets;

template <typename Scalar>
class PackedTets<Scalar, FleshEnergy> {
public:
    explicit PackedTets(const FleshEnergy& energy) : energy_(&energy) {}
    void add_batch() { batches_.emplace_back(); }
    void set_tet(int lane, int tet, const TetOffsets& offset);
    void set_dummy(int lane, const TetOffsets& offset);
    double add_gradient(const Scalar* x, Scalar* gradient)
    {
        return add_gradient_of_tets(batches_.data(), static_cast<int>(batches_.size()), x, gradient);
    }

private:
    const FleshEnergy* energy_;  // for set_tet alone
    std::vector<FleshBatch<Scalar>> batches_;
};

// A tet whose shapes the kernel refuses (local_shape_formula.hpp) is computed by projective_forces.
template <typename Scalar>
class PackedTets<Scalar, ProjectiveEnergy> {
public:
    explicit PackedTets(const ProjectiveEnergy& energy) : energy_(&energy), weights_(energy.weights()) {}
    void add_batch();
    void set_tet(int lane, int tet, const TetOffsets& offset);
    void set_dummy(int lane, const TetOffsets& offset);
    double add_gradient(const Scalar* x, Scalar* gradient);
    int refused() const { return refused_count_; }  // in the last call of add_gradient

private:
    double add_gradient_of_refused(int place, const Scalar* x, Scalar* gradient) const;

    const ProjectiveEnergy* energy_;  // for set_tet alone
    ProjectiveWeights weights_;
    std::vector<ProjectiveBatch<Scalar>> batches_;
    std::vector<int> refused_;  // room for the places, 16 batch + lane, of refused tets
    int refused_count_ = 0;
};

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
