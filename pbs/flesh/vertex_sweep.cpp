#include "pbs/flesh/vbd.hpp"

namespace pbs {

template <>
std::unique_ptr<VertexSweep<float>> make_vertex_sweep(const TetMesh& mesh, const FleshEnergy& energy, Arithmetic, int threads)
{
    return std::make_unique<PackedVertexSweep<float>>(mesh, energy, threads);
}

template <>
std::unique_ptr<VertexSweep<double>> make_vertex_sweep(const TetMesh& mesh, const FleshEnergy& energy, Arithmetic arithmetic, int threads)
{
    if (arithmetic == Arithmetic::plain_f64) return std::make_unique<PlainVertexSweep>(mesh, energy);
    return std::make_unique<PackedVertexSweep<double>>(mesh, energy, threads);
}

}  // namespace pbs
