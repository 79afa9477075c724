#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace experiments {

using analysis::Columns;
using Row = StiffnessRow;
using Setting = StiffnessSetting;

const Columns<Row> stiffness_columns =
    MEMBER_COLUMNS(Row, body, load, vertices, edges, tets, mesh) +
    within(&Row::setting, MEMBER_COLUMNS(Setting, method, k_stretch, young_pa, iterations, time_step_ms, order_seed)) +
    MEMBER_COLUMNS(Row, by, force_n, stiffness_n_m, converged, steps);

namespace {

constexpr double still = 1e-6;
constexpr int still_steps = 25;

// One distance per vertex, as the solver expects; zero where nothing is bound.
Eigen::VectorXd bind_distance_of(const LoadedBody& body)
{
    return body.bind_distance.size() ? body.bind_distance : Eigen::VectorXd::Zero(body.mesh.rest.rows());
}

// In double, without gravity.
pbs::PbsOptions pbs_options(const LoadedBody& body, const StiffnessSetting& setting)
{
    pbs::PbsOptions options;
    options.iterations = setting.iterations;
    options.k_stretch = setting.k_stretch;
    options.k_bind = body.bind_distance.size() ? 1.0 : 0.0;
    options.precision = pbs::Precision::f64;
    options.order = pbs::Order::plain;
    options.jiggle = pbs::Jiggle{setting.k_stretch};
    if (setting.method == Method::exponent) options.stiffness_form = pbs::StiffnessForm::exponent;
    return options;
}

pbs::XpbdOptions xpbd_options(const StiffnessSetting& setting)
{
    pbs::XpbdOptions options;
    options.young_pa = setting.young_pa;
    options.density_kg_m3 = flesh_density_kg_m3;
    options.iterations = setting.iterations_of_a_step();
    options.jiggle = true;
    options.keep_multipliers = setting.method != Method::xpbd_forgetting;
    return options;
}

template <typename Solver>
SteppedBody step(Solver& solver, const LoadedBody& body, double time_step_s, int most_steps)
{
    const pbs::Positions bind_point = body.bind_point.rows() ? body.bind_point : body.mesh.rest;
    SteppedBody result;
    double before_m = 0.0;
    for (int quiet = 0; result.steps < most_steps && quiet < still_steps; ++result.steps) {
        solver.advance(body.mesh.rest, bind_point, time_step_s);
        const double now_m = mean_displacement_m(body, solver.positions() - body.mesh.rest);
        if (!std::isfinite(now_m)) break;
        quiet = std::abs(now_m - before_m) <= still * std::abs(now_m) ? quiet + 1 : 0;
        result.converged = quiet == still_steps;
        before_m = now_m;
    }
    result.displacement = solver.positions() - body.mesh.rest;
    return result;
}

template <typename Constraint>
void shuffle_if(int seed, std::vector<Constraint>& constraints)
{
    std::mt19937_64 random(static_cast<unsigned long>(seed));
    if (seed != 0) std::shuffle(constraints.begin(), constraints.end(), random);
}

void add_pbs(const LoadedBody& body, const StiffnessSetting& setting, pbs::StepNearRest& step)
{
    auto set = pbs::make_constraint_set<double>(body.mesh, bind_distance_of(body), body.zone,
                                                pbs_options(body, setting), body.held);
    const auto add_class = [&](auto& constraints) {
        shuffle_if(setting.order_seed, constraints);
        for (const auto& constraint : constraints) step.add(constraint, constraint.stiffness, 0.0, set.inverse_mass);
    };
    add_class(set.bind);
    add_class(set.stretch);
    add_class(set.volume);
}

void add_xpbd(const LoadedBody& body, const StiffnessSetting& setting, pbs::StepNearRest& step)
{
    const pbs::XpbdConstraints of_body =
        make_xpbd_constraints(body.mesh, body.bind_distance, xpbd_options(setting), body.held);
    const auto add_class = [&](auto constraints) {
        shuffle_if(setting.order_seed, constraints);
        for (const auto& [constraint, compliance] : constraints)
            step.add(constraint, 1.0, compliance, of_body.inverse_mass);
    };
    add_class(of_body.bind);
    add_class(of_body.stretch);
    add_class(of_body.volume);
}

// still: pbs::RestingState or SteppedBody.
template <typename Still>
StiffnessRow row_of(const LoadedBody& body, const StiffnessSetting& setting, const std::string& by, const Still& still,
                    double gravity_m_s2)
{
    return {.body = body.name,
            .load = body.load,
            .vertices = static_cast<int>(body.mesh.rest.rows()),
            .edges = body.edges,
            .tets = static_cast<int>(body.mesh.tets.rows()),
            .setting = setting,
            .by = by,
            .force_n = weight_n(body, gravity_m_s2),
            .stiffness_n_m = effective_stiffness_n_m(body, still.displacement, gravity_m_s2),
            .converged = still.converged,
            .steps = still.steps};
}

constexpr double softer_pa = 3.0e4, stiffer_pa = 3.0e5;  // as stiff as few and as many iterations of PBS on the limb

std::vector<LoadedBody> bodies_of(const std::string& body, int vertices)
{
    if (body == "bar")
        return {hanging_bar(pbs::make_character({.body = body, .vertices = vertices > 0 ? vertices : 1000}).mesh)};
    const pbs::Character character = pbs::make_character({.body = body, .vertices = vertices, .surface = false});
    return {jiggling_flesh(character, RestOfBody::projected), jiggling_flesh(character, RestOfBody::held)};
}

// Small steps do not run on the bar, whose slowest motion takes more of them than the linear solver's Krylov space has.
// Where the rest of the body is projected, they are the control of the iterations alone.
bool suits(const StiffnessSweep& sweep, const LoadedBody& body, const StiffnessSetting& setting)
{
    if (setting.method != Method::xpbd_small_steps) return true;
    return body.load == "zone_on_held" || (body.load == "zone" && sweep.varied == Varied::iterations);
}

// More of them where the number of iterations is varied.
std::vector<StiffnessSetting> materials_of(const StiffnessSweep& sweep)
{
    const bool many = sweep.varied == Varied::iterations;
    std::vector<StiffnessSetting> materials;
    for (const double k : many ? std::vector{0.05, 0.2, 0.6, 0.9} : std::vector{0.2, 0.9})
        materials.push_back({.method = Method::pbs, .k_stretch = k});
    for (const double k : many ? std::vector{0.2, 0.9} : std::vector{0.2})
        materials.push_back({.method = Method::exponent, .k_stretch = k});
    materials.push_back({.method = Method::xpbd, .young_pa = softer_pa});
    if (many) materials.push_back({.method = Method::xpbd, .young_pa = stiffer_pa});
    materials.push_back({.method = Method::xpbd_small_steps, .young_pa = softer_pa});
    // no theory says what the failing control does on other meshes
    if (sweep.body == "limb" && sweep.varied != Varied::resolution)
        materials.push_back({.method = Method::xpbd_forgetting, .young_pa = softer_pa});
    return materials;
}

std::vector<int> iterations_of(const StiffnessSweep& sweep)
{
    if (sweep.varied != Varied::iterations) return {StiffnessSetting{}.iterations};
    return {3, 6, 12, 24, 48, 96, 192, 384};
}

std::vector<double> time_steps_ms_of(const StiffnessSweep& sweep)
{
    if (sweep.varied != Varied::time_step) return {StiffnessSetting{}.time_step_ms};
    return {1.25, 2.5, 5.0, 10.0, 20.0, 40.0};
}

// File order, and random orders next to the paper's number of iterations.
int orders_of(const StiffnessSweep& sweep, int iterations)
{
    return sweep.varied == Varied::iterations && iterations >= 12 && iterations <= 48 ? 3 : 1;
}

std::vector<StiffnessSetting> settings_of(const StiffnessSweep& sweep)
{
    std::vector<StiffnessSetting> settings;
    for (StiffnessSetting setting : materials_of(sweep))
        for (const int iterations : iterations_of(sweep))
            for (const double time_step_ms : time_steps_ms_of(sweep))
                for (int order = 0; order < orders_of(sweep, iterations); ++order) {
                    setting.iterations = iterations;
                    setting.time_step_ms = time_step_ms;
                    setting.order_seed = order;
                    settings.push_back(setting);
                }
    return settings;
}

// The solver itself is stepped too at time steps next to the paper's, where the body settles quickly.
bool is_stepped(const StiffnessSweep& sweep, const LoadedBody& body, const StiffnessSetting& setting)
{
    const bool next_to_the_paper = setting.time_step_ms >= 5.0 && setting.time_step_ms <= 20.0;
    const bool quick_to_settle = body.load != "cantilever" && setting.method != Method::xpbd_small_steps;
    return sweep.varied == Varied::time_step && next_to_the_paper && quick_to_settle;
}

struct Size {
    int vertices;
    const char* mesh;
};

std::vector<Size> sizes_of(const StiffnessSweep& sweep)
{
    std::vector<Size> sizes;
    for (const int vertices : sweep.vertices) {
        sizes.push_back({vertices, "wanted"});
        if (sweep.varied == Varied::resolution) sizes.push_back({vertices * 11 / 10, "tenth_finer"});
    }
    return sizes;
}

}  // namespace

RECORD_SETTINGS(StiffnessSetting, method, k_stretch, young_pa, iterations, time_step_ms, order_seed)

pbs::RestingState rest_near_rest(const LoadedBody& body, const StiffnessSetting& setting)
{
    const double step_s = setting.step_s();
    pbs::StepNearRest step(body.mesh.rest, body.bind_point, setting.iterations_of_a_step(), step_s,
                           setting.method == Method::xpbd_forgetting);
    if (is_xpbd(setting.method))
        add_xpbd(body, setting, step);
    else
        add_pbs(body, setting, step);
    pbs::RestingState rest = pbs::rest_of(step, body.zone, body.direction);
    for (std::size_t v = 0; v < body.zone.size(); ++v)
        if (body.zone[v])
            rest.displacement.row(static_cast<Eigen::Index>(v)) += step_s * step_s * body.direction.transpose();
    step.apply(rest.displacement);
    ++rest.steps;
    return rest;
}

SteppedBody step_until_still(const LoadedBody& body, const StiffnessSetting& setting, double gravity_m_s2,
                             int most_steps)
{
    const pbs::Vec3 gravity = gravity_m_s2 * body.direction;
    if (is_xpbd(setting.method)) {
        pbs::XpbdOptions options = xpbd_options(setting);
        options.gravity_m_s2 = gravity;
        pbs::XpbdSolver solver(body.mesh, body.bind_distance, body.zone, options, body.held);
        return step(solver, body, setting.step_s(), most_steps);
    }
    pbs::PbsOptions options = pbs_options(body, setting);
    options.gravity_m_s2 = gravity;
    pbs::PbsSolver solver(body.mesh, bind_distance_of(body), body.zone, options, body.held);
    return step(solver, body, setting.step_s(), most_steps);
}

StiffnessRow linear_stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    return row_of(body, setting, "linear", rest_near_rest(body, setting), 1.0);
}

StiffnessRow stepped_stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    return row_of(body, setting, "stepped", step_until_still(body, setting, still_gravity_m_s2), still_gravity_m_s2);
}

RECORD_SETTINGS_AND(StiffnessSweep,
                    .derived("settings", [](const StiffnessSweep& sweep) { return option_json(settings_of(sweep)); })
                        .constant("gravity_m_s2", still_gravity_m_s2)
                        .constant("density_kg_m3", flesh_density_kg_m3),
                    varied, body, vertices)

std::string record_stiffness(const StiffnessSweep& sweep, const std::string& folder)
{
    std::vector<StiffnessRow> rows;
    for (const Size& size : sizes_of(sweep))
        for (const LoadedBody& body : bodies_of(sweep.body, size.vertices))
            for (const StiffnessSetting& setting : settings_of(sweep)) {
                if (!suits(sweep, body, setting)) continue;
                rows.push_back(linear_stiffness(body, setting));
                rows.back().mesh = size.mesh;
                if (is_stepped(sweep, body, setting)) rows.push_back(stepped_stiffness(body, setting));
            }
    table_of(stiffness_columns, rows).write(analysis::path_in(folder, "stiffness.csv"));
    analysis::measurement_table(stiffness_ratios(rows, sweep.varied))
        .write(analysis::path_in(folder, "measurements.csv"));
    return "";
}

}  // namespace experiments
