#include "experiments/studies/fit/young_fit.hpp"

#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr double past_the_corners = 2.0;  // capsule radius over the mean distance of the skin
constexpr double range = 5.0;             // the modulus is searched within this factor of that by least squares

// The capsule of a bone is its middle, from 1/6 to 5/6: it begins before the bar and ends where the held part ends.
pbs::Skeleton bone_in_held_end(const pbs::Positions& rest)
{
    const pbs::Vec3 lower = rest.colwise().minCoeff(), upper = rest.colwise().maxCoeff();
    const pbs::Vec3 centre = (lower + upper) / 2.0;
    const double length = upper.x() - lower.x();
    const double first = lower.x() - 0.01 * length, last = lower.x() + held_share * length, sixth = (last - first) / 4.0;
    const auto on_axis = [&](double x) { return pbs::Vec3(x, centre.y(), centre.z()); };
    return {{{"held", -1, on_axis(first - sixth), on_axis(last + sixth)}}};
}

std::vector<std::vector<int>> fifths_of(const pbs::Positions& rest, const std::vector<bool>& held)
{
    const double last = rest.col(0).maxCoeff(), first = rest.col(0).minCoeff() + held_share * (last - rest.col(0).minCoeff());
    std::vector<std::vector<int>> fifths(5);
    for (Eigen::Index v = 0; v < rest.rows(); ++v)
        if (!held[v])
            fifths[std::clamp(static_cast<int>(5.0 * (rest(v, 0) - first) / (last - first)), 0, 4)].push_back(static_cast<int>(v));
    return fifths;
}

// One bone in the held end, whose vertices the finite elements hold exactly.
pbs::Character gripped(const pbs::TetMesh& bar)
{
    pbs::Character character;
    character.name = "cantilever";
    character.mesh = bar;
    character.skeleton = bone_in_held_end(bar.rest);
    character.binding = pbs::bind_to_nearest_bone(bar.rest, character.skeleton);
    character.weights = pbs::rigid_weights(character.binding);
    character.blended.assign(bar.rest.rows(), false);
    return character;
}

// Sum over some vertices of m a . b.
double product(const Cantilever& cantilever, const std::vector<int>& vertices, const pbs::Positions& a, const pbs::Positions& b)
{
    double sum = 0.0;
    for (const int v : vertices) sum += cantilever.body.mass_kg(v) * a.row(v).dot(b.row(v));
    return sum;
}

}  // namespace

Cantilever make_cantilever(const pbs::TetMesh& bar)
{
    Cantilever cantilever;
    cantilever.body = hanging_bar(bar);
    cantilever.fifths = fifths_of(bar.rest, cantilever.body.held);
    const pbs::Edges edges = pbs::edges_of(bar.tets);
    for (const auto& edge : edges.rowwise())
        cantilever.mean_edge_m += (bar.rest.row(edge(0)) - bar.rest.row(edge(1))).norm() / static_cast<double>(edges.rows());
    const double end = bar.rest.col(0).maxCoeff() - cantilever.mean_edge_m;
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v)
        if (bar.rest(v, 0) >= end) cantilever.tip.push_back(static_cast<int>(v));
    return cantilever;
}

double mean_sag_m(const Cantilever& cantilever, const pbs::Positions& displacement)
{
    double sum = 0.0;
    for (const int v : cantilever.tip) sum -= displacement(v, 2);
    return sum / static_cast<double>(cantilever.tip.size());
}

ElasticSag elastic_sag(const Cantilever& cantilever, FemOptions options)
{
    options.attachment = FemAttachment::nodes;
    options.core_radius = past_the_corners;
    options.model = reference_fem::Model::linear;
    options.gravity_m_s2 = -pbs::Vec3::UnitZ();
    DeformerSpec spec = default_spec("fem");
    spec.options = options;
    const pbs::Character character = gripped(cantilever.body.mesh);
    const auto fem = make_deformer(spec);
    fem->reset(character);
    if (fem->prescribed() != cantilever.body.held)
        throw pbs::InputError("cantilever", 0, "held", "", "expected the finite elements to hold the same vertices");
    fem->advance({Eigen::Isometry3d::Identity()}, 1.0);
    return {fem->positions() - character.mesh.rest, options};
}

YoungFit fit_young(const Cantilever& cantilever, const ElasticSag& elastic, const pbs::Positions& displacement, double gravity_m_s2)
{
    // Linear: the elastic body of modulus E is displaced by per_pa / E.
    const pbs::Positions per_pa = elastic.options.young_pa * gravity_m_s2 * elastic.displacement;
    std::vector<analysis::Misfit> misfits;
    double squares = 0.0, mixed = 0.0;
    for (const std::vector<int>& fifth : cantilever.fifths) {
        const double uu = product(cantilever, fifth, displacement, displacement), ue = product(cantilever, fifth, displacement, per_pa),
                     ee = product(cantilever, fifth, per_pa, per_pa);
        misfits.push_back([=](double young_pa) {
            return 100.0 * std::sqrt(std::max(0.0, (uu - 2.0 * ue / young_pa + ee / (young_pa * young_pa)) / uu));
        });
        squares += ee / uu;
        mixed += ue / uu;
    }
    const double least_squares_pa = squares / mixed;  // minimises the sum of squared misfits in closed form
    if (!(least_squares_pa > 0.0 && std::isfinite(least_squares_pa))) {
        YoungFit none;
        none.young_pa.estimate = none.young_pa.low = none.young_pa.high = analysis::not_known;
        return none;
    }
    const analysis::FittedParameter fit = analysis::fit_over_cases(misfits, least_squares_pa / range, least_squares_pa * range);
    return {fit.interval, fit.all};
}

}  // namespace experiments
