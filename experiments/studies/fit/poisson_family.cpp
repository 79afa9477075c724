#include "experiments/studies/fit/poisson_family.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace experiments {
namespace {

double logarithm_of(double poisson)
{
    return std::log10(1.0 - 2.0 * poisson);
}

double poisson_of(double logarithm)
{
    return (1.0 - std::pow(10.0, logarithm)) / 2.0;
}

}  // namespace

std::vector<double> poisson_nodes(int count)
{
    const double last = logarithm_of(highest_poisson);
    std::vector<double> nodes;
    for (int i = 0; i < count; ++i) nodes.push_back(poisson_of(last * (1.0 - std::cos(std::numbers::pi * i / (count - 1))) / 2.0));
    nodes.front() = 0.0;
    nodes.back() = highest_poisson;
    return nodes;
}

double between(const std::vector<double>& nodes, int i)
{
    return poisson_of((logarithm_of(nodes[i]) + logarithm_of(nodes[i + 1])) / 2.0);
}

PoissonFamily::PoissonFamily(const std::vector<double>& poisson, std::vector<pbs::Positions> positions) : positions_(std::move(positions))
{
    for (const double each : poisson) nodes_.push_back(logarithm_of(each));
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        double product = 1.0;
        for (std::size_t j = 0; j < nodes_.size(); ++j)
            if (j != i) product *= nodes_[i] - nodes_[j];
        weights_.push_back(1.0 / product);
    }
}

// The barycentric formula (J.-P. Berrut, L. N. Trefethen, SIAM Review 46, 2004, Eq. 4.2).
pbs::Positions PoissonFamily::at(double poisson) const
{
    const double x = logarithm_of(poisson);
    pbs::Positions sum = pbs::Positions::Zero(positions_.front().rows(), 3);
    double weights = 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (x == nodes_[i]) return positions_[i];
        const double weight = weights_[i] / (x - nodes_[i]);
        sum += weight * positions_[i];
        weights += weight;
    }
    return sum / weights;
}

}  // namespace experiments
