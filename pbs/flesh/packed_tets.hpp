// The tets of one slab, sixteen side by side, as PackedSystem (packed_flesh.hpp) needs them: one specialisation for each energy.
//   PackedTets<float, FleshEnergy> tets(energy);
//   tets.add_batch();
//   tets.set_tet(lane, t, offset);        // tet t of the energy in the last batch
//   tets.set_dummy(lane, offset);         // a lane without a tet
//   double e = tets.add_gradient(x, gradient);
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/projective_dynamics.hpp"

#include <array>
#include <vector>

namespace pbs {

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
    std::size_t bytes() const { return batches_.size() * sizeof(FleshBatch<Scalar>); }

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
    std::size_t bytes() const { return batches_.size() * sizeof(ProjectiveBatch<Scalar>); }
    int refused() const { return refused_count_; }  // in the last call of add_gradient

private:
    double add_gradient_of_refused(int place, const Scalar* x, Scalar* gradient) const;

    const ProjectiveEnergy* energy_;  // for set_tet alone
    ProjectiveWeights weights_;
    std::vector<ProjectiveBatch<Scalar>> batches_;
    std::vector<int> refused_;  // room for the places, 16 batch + lane, of refused tets
    int refused_count_ = 0;
};

}  // namespace pbs
