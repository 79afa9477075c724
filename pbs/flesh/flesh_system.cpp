#include "pbs/flesh/flesh_system.hpp"

#include "pbs/flesh/packed_flesh.hpp"
#include "pbs/flesh/plain_flesh.hpp"

#include <type_traits>

namespace pbs {

template <typename Scalar, typename Energy>
std::unique_ptr<FleshSystem<Scalar>> make_flesh_system(const TetMesh& mesh, const Energy& energy, const CholeskyFactor& factor,
                                                       Arithmetic arithmetic, int threads)
{
    if constexpr (std::is_same_v<Scalar, double>)
        if (arithmetic == Arithmetic::plain_f64) return std::make_unique<PlainSystem<Energy>>(energy, factor);
    return std::make_unique<PackedSystem<Scalar, Energy>>(mesh, energy, factor, threads);
}

template std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh&, const FleshEnergy&, const CholeskyFactor&, Arithmetic, int);
template std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh&, const FleshEnergy&, const CholeskyFactor&, Arithmetic, int);
template std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh&, const ProjectiveEnergy&, const CholeskyFactor&, Arithmetic,
                                                               int);
template std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh&, const ProjectiveEnergy&, const CholeskyFactor&, Arithmetic,
                                                                int);

}  // namespace pbs
