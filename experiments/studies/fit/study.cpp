// The fit: which elastic body the paper's constraints are, so that k has a unit and comparisons are fair.
//
//   sag_N      ###=========      A bar of N vertices that is held at one end settles under gravity: Young's modulus
//   against k_stretch,
//              ###      \  g     k_volume and iterations. The modulus scales with density / (time step)^2, exactly.
//
// Writes DIR/fit/sag.csv.
#include "experiments/studies/fit/fit.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/near_rest/near_rest.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace experiments {
namespace {

constexpr double past_the_corners = 2.0;  // capsule radius over the mean distance of the skin
constexpr double range =
    5.0;  // the interval of the modulus, and the modulus without a fifth, are within this factor of it
constexpr double least_rise =
    0.01;  // of the misfit, for a change of the modulus by 10 %; below it the modulus is not identifiable

// The capsule of a bone is its middle, from 1/6 to 5/6: it begins before the bar and ends where the held part ends.
pbs::Skeleton bone_in_held_end(const pbs::Positions& rest)
{
    const pbs::Vec3 lower = rest.colwise().minCoeff(), upper = rest.colwise().maxCoeff();
    const pbs::Vec3 centre = (lower + upper) / 2.0;
    const double length = upper.x() - lower.x();
    const double first = lower.x() - 0.01 * length, last = lower.x() + held_share * length,
                 sixth = (last - first) / 4.0;
    const auto on_axis = [&](double x) { return pbs::Vec3(x, centre.y(), centre.z()); };
    return {{{"held", -1, on_axis(first - sixth), on_axis(last + sixth)}}};
}

std::vector<std::vector<int>> fifths_of(const pbs::Positions& rest, const std::vector<bool>& held)
{
    const double last = rest.col(0).maxCoeff(),
                 first = rest.col(0).minCoeff() + held_share * (last - rest.col(0).minCoeff());
    std::vector<std::vector<int>> fifths(5);
    for (Eigen::Index v = 0; v < rest.rows(); ++v)
        if (!held[v])
            fifths[std::clamp(static_cast<int>(5.0 * (rest(v, 0) - first) / (last - first)), 0, 4)].push_back(
                static_cast<int>(v));
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
double product(const Cantilever& cantilever, const std::vector<int>& vertices, const pbs::Positions& a,
               const pbs::Positions& b)
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
        cantilever.mean_edge_m +=
            (bar.rest.row(edge(0)) - bar.rest.row(edge(1))).norm() / static_cast<double>(edges.rows());
    const double end = bar.rest.col(0).maxCoeff() - cantilever.mean_edge_m;
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v)
        if (bar.rest(v, 0) >= end) cantilever.tip.push_back(static_cast<int>(v));
    return cantilever;
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
    if (prescribed_vertices(*fem) != cantilever.body.held)
        throw pbs::InputError("cantilever", 0, "held", "", "expected the finite elements to hold the same vertices");
    fem->advance({Eigen::Isometry3d::Identity()}, 1.0);
    return {fem->positions() - character.mesh.rest, options};
}

YoungFit fit_young(const Cantilever& cantilever, const ElasticSag& elastic, const pbs::Positions& displacement,
                   double gravity_m_s2)
{
    // Linear: the elastic body of modulus E is displaced by e / E, e = per_pa. With c = 1 / E the squared misfit of a
    // fifth is the parabola 1 - 2 c m + c^2 s, m = u . e / u . u, s = e . e / u . u. The mean over the fifths is least
    // at c = (sum of m) / (sum of s).
    const pbs::Positions per_pa = elastic.options.young_pa * gravity_m_s2 * elastic.displacement;
    std::vector<double> m, s;
    for (const std::vector<int>& fifth : cantilever.fifths) {
        const double uu = product(cantilever, fifth, displacement, displacement);
        m.push_back(product(cantilever, fifth, displacement, per_pa) / uu);
        s.push_back(product(cantilever, fifth, per_pa, per_pa) / uu);
    }
    const double mixed = std::accumulate(m.begin(), m.end(), 0.0), squares = std::accumulate(s.begin(), s.end(), 0.0);
    const double young_pa = squares / mixed;
    YoungFit fit;
    fit.young_pa.estimate = fit.young_pa.low = fit.young_pa.high = analysis::not_known;
    if (!(young_pa > 0.0 && std::isfinite(young_pa))) return fit;

    const auto misfit_pct = [&](double c) {
        return 100.0 *
               std::sqrt(std::max(0.0, 1.0 + (c * c * squares - 2.0 * c * mixed) / static_cast<double>(m.size())));
    };
    fit.misfit_pct = misfit_pct(1.0 / young_pa);
    fit.rise = std::min(misfit_pct(1.0 / (0.9 * young_pa)), misfit_pct(1.0 / (1.1 * young_pa))) / fit.misfit_pct - 1.0;
    fit.outcome = "converged";
    fit.identifiable = fit.rise >= least_rise;
    // The modulus of the other fifths, within the limits of the interval. The limits hold for c, because a sum of m
    // below 0 stands for the largest modulus.
    std::vector<double> without_pa;
    for (std::size_t i = 0; i < m.size(); ++i)
        without_pa.push_back(1.0 /
                             std::clamp((mixed - m[i]) / (squares - s[i]), 1.0 / (range * young_pa), range / young_pa));
    fit.young_pa = analysis::jackknife_interval(young_pa, without_pa);
    fit.young_pa.low = std::max(fit.young_pa.low, young_pa / range);
    fit.young_pa.high = std::min(fit.young_pa.high, young_pa * range);
    return fit;
}

const analysis::Columns<analysis::Interval> young_columns = {{"young_pa", &analysis::Interval::estimate},
                                                             {"young_low_pa", &analysis::Interval::low},
                                                             {"young_high_pa", &analysis::Interval::high}};

const analysis::Columns<SagRow> sag_columns =
    within(&SagRow::setting, MEMBER_COLUMNS(BarSetting, vertices, mean_edge_m, k_stretch, k_volume, iterations,
                                            time_step_s, masses, density_kg_m3, poisson)) +
    within(&SagRow::fit, within(&YoungFit::young_pa, young_columns) +
                             MEMBER_COLUMNS(YoungFit, misfit_pct, rise, outcome, identifiable)) +
    analysis::Columns<SagRow>{{"young_dt2_over_density_edge2_iterations", &SagRow::scaled_young}} +
    MEMBER_COLUMNS(SagRow, tip_sag_over_g_dt2, settled, residual, solver_steps);

RECORD_SETTINGS_AND(SagCase,
                    .constant("time_step_s", sag_time_step_s)
                        .constant("density_kg_m3", sag_density_kg_m3)
                        .constant("poisson", sag_poisson),
                    vertices, k_stretch, k_volume, iterations)

namespace {

struct Rig {
    Cantilever cantilever;
    ElasticSag elastic;  // of 1 Pa under 1 m/s^2
};

Rig make_rig(int vertices)
{
    FemOptions options;  // linear, P2
    options.young_pa = 1.0;
    options.poisson = sag_poisson;
    options.density_kg_m3 = sag_density_kg_m3;
    Cantilever cantilever = make_cantilever(pbs::make_character({.body = "bar", .vertices = vertices}).mesh);
    ElasticSag elastic = elastic_sag(cantilever, options);
    return {std::move(cantilever), std::move(elastic)};
}

pbs::PbsOptions pbs_options(const BarSetting& setting)
{
    pbs::PbsOptions options;
    options.k_stretch = setting.k_stretch;
    options.k_volume = setting.k_volume;
    options.k_bind = 0.0;
    options.iterations = setting.iterations;
    options.masses = option_of<pbs::Masses>(setting.masses);
    return options;
}

// The mean downward displacement of the tip [m].
double mean_sag_m(const Cantilever& cantilever, const pbs::Positions& displacement)
{
    double sum = 0.0;
    for (const int v : cantilever.tip) sum -= displacement(v, 2);
    return sum / static_cast<double>(cantilever.tip.size());
}

SagRow sag_row(const Rig& rig, const BarSetting& setting)
{
    const pbs::RestingState state =
        pbs::settle(rig.cantilever.body.mesh, rig.cantilever.body.held, pbs_options(setting), -pbs::Vec3::UnitZ());
    // under 1 m/s^2
    const pbs::Positions displacement_m = setting.time_step_s * setting.time_step_s * state.displacement;
    const YoungFit fit = fit_young(rig.cantilever, rig.elastic, displacement_m, 1.0);
    const double dt_edge = setting.time_step_s / setting.mean_edge_m;
    return {.setting = setting,
            .fit = fit,
            .scaled_young = fit.young_pa.estimate * dt_edge * dt_edge / setting.density_kg_m3 / setting.iterations,
            .tip_sag_over_g_dt2 = mean_sag_m(rig.cantilever, state.displacement),
            .settled = state.converged,
            .residual = state.residual,
            .solver_steps = state.steps};
}

std::string record_sags(const SagCase& sag_case, const std::string& folder)
{
    const Rig rig = make_rig(sag_case.vertices);
    const auto vertices = static_cast<int>(rig.cantilever.body.mesh.rest.rows());
    std::vector<SagRow> rows;
    for (const double k_stretch : sag_case.k_stretch)
        for (const double k_volume : sag_case.k_volume)
            for (const int n : sag_case.iterations)
                rows.push_back(sag_row(rig, {vertices, rig.cantilever.mean_edge_m, k_stretch, k_volume, n}));
    table_of(sag_columns, rows).write(analysis::path_in(folder, "sag.csv"));
    return "";
}

StudyPlan plan(bool full)
{
    return plan_of_cases("fit", full, [](const StudyCase& study_case, StudyPlan& plan) {
        plan.runs.push_back(
            work_run<SagCase>(study_case.name, {study_case.value<int>("vertices")}, study_case.cost_s, record_sags));
    });
}

bool conclude(const FinishedRuns& finished)
{
    finished.write("sag.csv", sag_columns, finished.rows(sag_columns, "sag.csv"));
    return true;
}

}  // namespace

Study fit_study()
{
    return {"fit", plan, full_in_short, conclude};
}

}  // namespace experiments
