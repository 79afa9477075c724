#include "experiments/studies/fit/poisson_fit.hpp"

#include "experiments/deformers/registry.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace experiments {
namespace {

constexpr double level = 0.95;
constexpr int valley_points = 101;
constexpr std::size_t least_nodes = 4;

double logarithm_of(double poisson)
{
    return std::log10(1.0 - 2.0 * poisson);
}

double poisson_of(double logarithm)
{
    return (1.0 - std::pow(10.0, logarithm)) / 2.0;
}

analysis::ErrorMetrics joint_metrics(const pbs::Character& character, const std::vector<bool>& prescribed)
{
    analysis::ErrorDomain domain{character.mesh.rest, character.mesh.tets, prescribed, {}, character.binding.distance};
    for (std::size_t v = 0; v < character.blended.size(); ++v)
        if (character.blended[v]) domain.blended.push_back(static_cast<int>(v));
    return analysis::ErrorMetrics(domain);
}

// The poses of a path at one Poisson's ratio, up to the first that did not converge.
struct Solved {
    std::vector<pbs::Positions> positions;
    std::vector<bool> prescribed;
};

Solved solve(const pbs::Character& character, const std::vector<NamedPose>& path, FemOptions options, double poisson)
{
    options.poisson = poisson;
    DeformerSpec spec = default_spec("fem");
    spec.options = options;
    const std::unique_ptr<Deformer> fem = make_deformer(spec);
    fem->reset(character);
    Solved solved;
    for (const NamedPose& each : path) {
        if (fem->advance(each.pose, 1.0).outcome != pbs::Outcome::finished || !fem->positions().allFinite()) break;
        solved.positions.push_back(fem->positions());
    }
    solved.prescribed = prescribed_vertices(*fem);
    return solved;
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

ElasticPoses::ElasticPoses(const pbs::Character& character, const std::vector<std::vector<NamedPose>>& paths, const FemOptions& options,
                           int ratios)
{
    for (const auto& path : paths) add_path(character, path, options, poisson_nodes(ratios));
}

void ElasticPoses::add_path(const pbs::Character& character, const std::vector<NamedPose>& path, const FemOptions& options,
                            const std::vector<double>& nodes)
{
    std::vector<Solved> at_nodes;
    for (const double poisson : nodes) at_nodes.push_back(solve(character, path, options, poisson));
    prescribed_ = at_nodes.front().prescribed;
    std::size_t usable_in_all = nodes.size();
    std::vector<std::size_t> usable(path.size(), 0);  // nodes up to the first that did not converge
    for (std::size_t p = 0; p < path.size(); ++p) {
        while (usable[p] < nodes.size() && p < at_nodes[usable[p]].positions.size()) ++usable[p];
        usable_in_all = std::min(usable_in_all, usable[p]);
    }
    const std::size_t first = poses_.size();
    for (std::size_t p = 0; p < path.size(); ++p) {
        Elastic elastic{path[p], std::nullopt, usable[p] > 0 ? nodes[usable[p] - 1] : 0.0, 0.0};
        std::vector<pbs::Positions> positions;
        for (std::size_t i = 0; i < usable[p]; ++i) positions.push_back(at_nodes[i].positions[p]);
        if (usable[p] >= least_nodes)
            elastic.family.emplace(std::vector<double>(nodes.begin(), nodes.begin() + static_cast<int>(usable[p])), std::move(positions));
        poses_.push_back(std::move(elastic));
    }
    if (usable_in_all < least_nodes) return;
    const analysis::ErrorMetrics error_metrics = joint_metrics(character, prescribed_);
    for (const int before : {static_cast<int>(nodes.size()) / 2 - 1, static_cast<int>(usable_in_all) - 2}) {
        const double poisson = between(nodes, before);
        const Solved check = solve(character, path, options, poisson);
        for (std::size_t p = 0; p < check.positions.size(); ++p) {
            Elastic& elastic = poses_[first + p];
            elastic.interpolation_error_pct =
                std::max(elastic.interpolation_error_pct, error_metrics.measure(elastic.family->at(poisson), check.positions[p]).joint_pct);
        }
    }
}

std::optional<PoissonFit> fit_poisson(const pbs::Character& character, const ElasticPoses& elastic,
                                      const std::vector<pbs::Positions>& positions)
{
    const analysis::ErrorMetrics error_metrics = joint_metrics(character, elastic.prescribed());
    std::vector<analysis::Misfit> misfits;
    PoissonFit fit;
    fit.highest_poisson = highest_poisson;
    for (std::size_t p = 0; p < elastic.poses().size(); ++p) {
        const auto& pose = elastic.poses()[p];
        if (!pose.family) continue;
        fit.poses.push_back(pose.pose.name);
        fit.highest_poisson = std::min(fit.highest_poisson, pose.highest_poisson);
        misfits.push_back([&error_metrics, &pose, &body = positions[p]](double poisson) {
            return error_metrics.measure(body, pose.family->at(poisson)).joint_pct;
        });
    }
    if (misfits.empty()) return std::nullopt;
    fit.poisson = analysis::fit_over_cases(misfits, 0.0, fit.highest_poisson, {}, level);
    for (int i = 0; i < valley_points; ++i) {
        const double poisson = fit.highest_poisson * i / (valley_points - 1);
        double squares = 0.0;
        for (const auto& misfit : misfits) squares += std::pow(misfit(poisson), 2);
        fit.valley.push_back({poisson, std::sqrt(squares / static_cast<double>(misfits.size()))});
    }
    return fit;
}

}  // namespace experiments
