#include "experiments/studies/bench/machine_kernels.hpp"

#include <experimental/simd>

namespace experiments {
namespace {

namespace stdx = std::experimental;

constexpr int chains = 12;  // more than the latency (4) times the throughput (2) of a multiply-add

}  // namespace

template <typename Scalar>
double multiply_add(std::size_t rounds, Scalar start, Scalar a, Scalar b, Scalar& sum)
{
    using Lanes = stdx::native_simd<Scalar>;
    Lanes x[chains];
    for (int chain = 0; chain < chains; ++chain) x[chain] = start + Scalar(chain);
    const Lanes factor = a, summand = b;
    for (std::size_t round = 0; round < rounds; ++round)
#pragma GCC unroll 12
        for (int chain = 0; chain < chains; ++chain) x[chain] = x[chain] * factor + summand;
    sum = Scalar(0);
    for (const Lanes& of_chain : x) sum += stdx::reduce(of_chain);
    return 2.0 * double(rounds) * chains * double(Lanes::size());
}

void copy_floats(const float* from, float* to, std::size_t count)
{
    using Lanes = stdx::native_simd<float>;
    constexpr std::size_t stride = 4 * Lanes::size();
    for (std::size_t i = 0; i < count; i += stride)
#pragma GCC unroll 4
        for (std::size_t k = 0; k < stride; k += Lanes::size())
            Lanes(from + i + k, stdx::vector_aligned).copy_to(to + i + k, stdx::vector_aligned);
}

void scale_floats(float factor, float* x, std::size_t count)
{
    using Lanes = stdx::native_simd<float>;
    const Lanes factors = factor;
    constexpr std::size_t stride = 4 * Lanes::size();
    for (std::size_t i = 0; i < count; i += stride)
#pragma GCC unroll 4
        for (std::size_t k = 0; k < stride; k += Lanes::size())
            (factors * Lanes(x + i + k, stdx::vector_aligned)).copy_to(x + i + k, stdx::vector_aligned);
}

template double multiply_add(std::size_t, float, float, float, float&);
template double multiply_add(std::size_t, double, double, double, double&);

}  // namespace experiments
