#include "pbs/flesh/flesh_system.hpp"

#include "pbs/flesh/packed_flesh.hpp"
#include "pbs/flesh/plain_flesh.hpp"

namespace pbs {

template <>
std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor,
                                                      Arithmetic, int threads)
{
    return std::make_unique<PackedFlesh<float>>(mesh, energy, factor, threads);
}

template <>
std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor,
                                                       Arithmetic arithmetic, int threads)
{
    if (arithmetic == Arithmetic::plain_f64) return std::make_unique<PlainFlesh>(energy, factor);
    return std::make_unique<PackedFlesh<double>>(mesh, energy, factor, threads);
}

}  // namespace pbs
