#include "pbs/flesh/vbd.hpp"

#include "pbs/geometry/input_error.hpp"

#include <string>
#include <utility>

namespace pbs {
namespace {

VertexBlockOptions checked(const VertexBlockOptions& options)
{
    if (!(options.omega > 0.0 && options.omega < 2.0))
        throw InputError("vertex block descent", 0, "omega", std::to_string(options.omega), "expected 0 < omega < 2");
    if (!(options.rho >= 0.0 && options.rho < 1.0))
        throw InputError("vertex block descent", 0, "rho", std::to_string(options.rho), "expected 0 <= rho < 1");
    return options;
}

}  // namespace

std::vector<double> chebyshev_weights(double rho, int count)
{
    std::vector<double> weights;
    for (int k = 1; k <= count; ++k)
        weights.push_back(k == 1 ? 1.0 : k == 2 ? 2.0 / (2.0 - rho * rho) : 4.0 / (4.0 - rho * rho * weights.back()));
    return weights;
}

template <typename Scalar>
VertexBlockDescent<Scalar>::VertexBlockDescent(const TetMesh& mesh, const FleshEnergy& energy, const VertexBlockOptions& options)
    : options_(checked(options)), sweep_(make_vertex_sweep<Scalar>(mesh, energy, options.arithmetic, options.threads)), x_(sweep_->rows())
{
    if (options.acceleration == Acceleration::chebyshev) weights_ = chebyshev_weights(options.rho, options.iterations);
}

template <typename Scalar>
VertexBlockSummary VertexBlockDescent<Scalar>::minimise(const Positions& centres, Positions& x)
{
    sweep_->set_centres(centres);
    sweep_->load(x, x_);
    if (options_.acceleration == Acceleration::chebyshev)
        sweep_with_chebyshev();
    else
        sweep_over_relaxed();
    sweep_->store(x_, x);
    return {options_.iterations, x.allFinite()};
}

template <typename Scalar>
void VertexBlockDescent<Scalar>::sweep_over_relaxed()
{
    for (int k = 0; k < options_.iterations; ++k) sweep_->move(options_.omega, x_);
}

template <typename Scalar>
void VertexBlockDescent<Scalar>::sweep_with_chebyshev()
{
    before_ = x_;
    for (const double weight : weights_) {
        before_that_ = before_;
        before_ = x_;
        sweep_->move(1.0, x_);
        if (weight != 1.0) sweep_->extrapolate(weight, before_that_, x_);
    }
}

template class VertexBlockDescent<float>;
template class VertexBlockDescent<double>;

}  // namespace pbs
