#include "experiments/fit/poisson_fit.hpp"

#include "experiments/deformers/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace experiments {
namespace {

constexpr double level = 0.95;
constexpr int valley_points = 101;

analysis::ErrorRuler joint_ruler(const pbs::Character& character, const std::vector<bool>& prescribed)
{
    analysis::ErrorDomain domain{character.mesh.rest, character.mesh.tets, prescribed, {}, character.binding.distance};
    for (std::size_t v = 0; v < character.blended.size(); ++v)
        if (character.blended[v]) domain.blended.push_back(static_cast<int>(v));
    return analysis::ErrorRuler(domain);
}

// The poses of a path at one Poisson's ratio; nothing from the first that did not converge.
struct Solved {
    std::vector<pbs::Positions> positions;
    std::vector<bool> prescribed;
};

Solved solve(const pbs::Character& character, const std::vector<NamedPose>& path, FemOptions options, double poisson)
{
    options.poisson = poisson;
    DeformerSpec spec;
    spec.kind = "fem";
    spec.fem = options;
    const std::unique_ptr<Deformer> fem = make_deformer(spec);
    fem->reset(character);
    Solved solved;
    for (const NamedPose& each : path) {
        if (fem->advance(each.pose, 1.0).outcome != pbs::Outcome::finished || !fem->positions().allFinite()) break;
        solved.positions.push_back(fem->positions());
    }
    solved.prescribed = fem->prescribed();
    return solved;
}

}  // namespace

ElasticPoses::ElasticPoses(const pbs::Character& character, const std::vector<std::vector<NamedPose>>& paths, const FemOptions& options,
                           int ratios)
{
    const std::vector<double> nodes = poisson_nodes(ratios);
    const std::vector<double> checks = {between(nodes, ratios / 2 - 1), between(nodes, ratios - 2)};
    for (const auto& path : paths) {
        std::vector<Solved> at_nodes, at_checks;
        for (const double poisson : nodes) at_nodes.push_back(solve(character, path, options, poisson));
        for (const double poisson : checks) at_checks.push_back(solve(character, path, options, poisson));
        prescribed_ = at_nodes.front().prescribed;
        const analysis::ErrorRuler ruler = joint_ruler(character, prescribed_);
        for (std::size_t p = 0; p < path.size(); ++p) {
            Elastic elastic{path[p], std::nullopt, "", 0.0};
            std::vector<pbs::Positions> positions;
            for (std::size_t i = 0; i < nodes.size(); ++i)
                if (p < at_nodes[i].positions.size())
                    positions.push_back(at_nodes[i].positions[p]);
                else
                    elastic.breakdown += fmt::format("nu {:.4g} did not converge. ", nodes[i]);
            if (elastic.breakdown.empty()) {
                elastic.family.emplace(nodes, std::move(positions));
                for (std::size_t c = 0; c < checks.size(); ++c)
                    if (p < at_checks[c].positions.size())
                        elastic.interpolation_error_pct =
                            std::max(elastic.interpolation_error_pct,
                                     ruler.measure(elastic.family->at(checks[c]), at_checks[c].positions[p]).joint_pct);
            }
            poses_.push_back(std::move(elastic));
        }
    }
}

std::optional<PoissonFit> fit_poisson(const pbs::Character& character, const ElasticPoses& elastic,
                                      const std::vector<pbs::Positions>& positions)
{
    const analysis::ErrorRuler ruler = joint_ruler(character, elastic.prescribed());
    std::vector<analysis::Misfit> misfits;
    PoissonFit fit;
    for (std::size_t p = 0; p < elastic.poses().size(); ++p) {
        const auto& pose = elastic.poses()[p];
        if (!pose.family) continue;
        fit.poses.push_back(pose.pose.name);
        misfits.push_back(
            [&ruler, &pose, &body = positions[p]](double poisson) { return ruler.measure(body, pose.family->at(poisson)).joint_pct; });
    }
    if (misfits.empty()) return std::nullopt;
    fit.poisson = analysis::fit_over_cases(misfits, 0.0, highest_poisson, {}, level);
    for (int i = 0; i < valley_points; ++i) {
        const double poisson = highest_poisson * i / (valley_points - 1);
        double squares = 0.0;
        for (const auto& misfit : misfits) squares += std::pow(misfit(poisson), 2);
        fit.valley.push_back({poisson, std::sqrt(squares / static_cast<double>(misfits.size()))});
    }
    return fit;
}

}  // namespace experiments
