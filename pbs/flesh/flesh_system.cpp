#include "pbs/flesh/flesh_system.hpp"

#include "pbs/flesh/packed_flesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace pbs {

// Measured at rest, where all steps are rounding: 0.4 roundings of a bar of 208 vertices in every arithmetic.
template <typename Scalar>
double FleshSystem<Scalar>::smallest_step(const Rows<Scalar>& x, double share, double first) const
{
    constexpr double roundings = 4.0;
    return std::max(share * first, roundings * std::numeric_limits<Scalar>::epsilon() * std::sqrt(dot(x, x)));
}

template double FleshSystem<float>::smallest_step(const Rows<float>&, double, double) const;
template double FleshSystem<double>::smallest_step(const Rows<double>&, double, double) const;

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
