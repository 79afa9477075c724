#include "pbs/solver/pbs_solver.hpp"

#include "pbs/solver/algorithm_1.hpp"

#include <variant>

namespace pbs {

using AnyAlgorithm1 = std::variant<Algorithm1<float>, Algorithm1<double>>;

class PbsSolver::Implementation {
public:
    AnyAlgorithm1 algorithm;
};

PbsSolver::PbsSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                     const PbsOptions& options, const std::vector<bool>& held)
{
    const auto build = [&]() -> AnyAlgorithm1 {
        if (options.precision == Precision::f32) return Algorithm1<float>(mesh, bind_distance, jiggle_zone, options, held);
        return Algorithm1<double>(mesh, bind_distance, jiggle_zone, options, held);
    };
    implementation_ = std::make_unique<Implementation>(Implementation{build()});
}

PbsSolver::~PbsSolver() = default;

StepSummary PbsSolver::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    return std::visit([&](auto& algorithm) { return algorithm.advance(lbs_positions, bind_points, dt_s); }, implementation_->algorithm);
}

const Positions& PbsSolver::positions() const
{
    return std::visit([](const auto& algorithm) -> const Positions& { return algorithm.positions(); }, implementation_->algorithm);
}

}  // namespace pbs
