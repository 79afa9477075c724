#include "experiments/studies/fit/bar_runs.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/fit/young_fit.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/near_rest/near_rest.hpp"

#include <cmath>
#include <numbers>

namespace experiments {

using analysis::Columns;

const Columns<FitQuality>& quality_columns()
{
    static const Columns<FitQuality> columns = {
        {"misfit_pct", &FitQuality::misfit_pct, "%", "what no value of the parameter removes"},
        {"rise", &FitQuality::rise, "", "share by which the misfit rises when the parameter changes by 10 %"},
        {"outcome", &FitQuality::outcome, "", "how the search ended"},
        {"identifiable", &FitQuality::identifiable, "", "the misfit has a minimum that determines the parameter"}};
    return columns;
}

namespace {

const Columns<BarSetting> bar_columns = {{"vertices", &BarSetting::vertices, "", "number of vertices"},
                                         {"mean_edge_m", &BarSetting::mean_edge_m, "m", "mean length of the edges"},
                                         {"k_stretch", &BarSetting::k_stretch, "", "stiffness of the stretch constraints"},
                                         {"k_volume", &BarSetting::k_volume, "", "stiffness of the volume constraints"},
                                         {"iterations", &BarSetting::iterations, "", "iterations per step"},
                                         {"time_step_s", &BarSetting::time_step_s, "s", "time step"},
                                         {"masses", &BarSetting::masses, "", "masses of PBS"},
                                         {"density_kg_m3", &BarSetting::density_kg_m3, "kg/m^3", "density of the elastic body"},
                                         {"poisson", &BarSetting::poisson, "", "Poisson's ratio of the elastic body"}};

const Columns<ReleaseTest> test_columns = {{"frequency_hz", &ReleaseTest::frequency_hz, "Hz", "first frequency, damped"},
                                           {"damping_ratio", &ReleaseTest::damping_ratio, "", "damping over critical damping"},
                                           {"undamped_hz", &ReleaseTest::undamped_hz, "Hz", "that frequency without its damping"},
                                           {"half_periods", &ReleaseTest::half_periods, "", "half periods that were measured"},
                                           {"steps", &ReleaseTest::steps, "", "time steps"},
                                           {"outcome", &ReleaseTest::outcome, "", "finished, no_crossing or not_finite"}};

}  // namespace

const Columns<SagRow> sag_columns =
    within(&SagRow::setting, bar_columns) +
    Columns<SagRow>{{"young_pa", &SagRow::young_pa, "Pa", "Young's modulus of the elastic bar that sags as PBS does"},
                    {"young_low_pa", &SagRow::young_low_pa, "Pa", "lower end of its interval"},
                    {"young_high_pa", &SagRow::young_high_pa, "Pa", "upper end of its interval"}} +
    within(&SagRow::quality, quality_columns()) +
    Columns<SagRow>{
        {"young_dt2_over_density_edge2_iterations", &SagRow::scaled_young, "", "E dt^2 / (density edge^2 iterations)"},
        {"tip_sag_over_g_dt2", &SagRow::tip_sag_over_g_dt2, "", "sag of the tip over gravity times the square of the time step"},
        {"settled", &SagRow::settled, "", "a state of rest was found"},
        {"residual", &SagRow::residual, "", "what is left of the equation of rest"},
        {"solver_steps", &SagRow::solver_steps, "", "applications of the linear map"}};

const Columns<SwingRow> swing_columns =
    within(&SwingRow::setting, bar_columns) + within(&SwingRow::test, test_columns) +
    Columns<SwingRow>{{"young_pa", &SwingRow::young_pa, "Pa", "Young's modulus by the first frequency"},
                      {"young_sag_pa", &SwingRow::young_sag_pa, "Pa", "Young's modulus by the sag"},
                      {"young_over_sag", &SwingRow::young_over_sag, "", "the former over the latter"},
                      {"expected_over_sag", &SwingRow::expected_over_sag, "", "that ratio by the recurrence of Algorithm 1"}};

namespace {

constexpr double sag_time_step_s = 0.01, density_kg_m3 = 1000.0, elastic_poisson = 0.45;

struct Rig {
    Cantilever cantilever;
    ElasticSag elastic;  // of 1 Pa under 1 m/s^2
};

Rig make_rig(int vertices)
{
    FemOptions options;  // linear, P2
    options.young_pa = 1.0;
    options.poisson = elastic_poisson;
    options.density_kg_m3 = density_kg_m3;
    Cantilever cantilever = make_cantilever(pbs::make_character({.body = "bar", .vertices = vertices}).mesh);
    ElasticSag elastic = elastic_sag(cantilever, options);
    return {std::move(cantilever), std::move(elastic)};
}

BarSetting setting_of(const Rig& rig, double k_stretch, double k_volume, int iterations, double dt_s)
{
    return {.vertices = static_cast<int>(rig.cantilever.body.mesh.rest.rows()),
            .mean_edge_m = rig.cantilever.mean_edge_m,
            .k_stretch = k_stretch,
            .k_volume = k_volume,
            .iterations = iterations,
            .time_step_s = dt_s,
            .density_kg_m3 = density_kg_m3,
            .poisson = elastic_poisson};
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

struct Settled {
    pbs::RestingState state;
    pbs::Positions displacement;  // [m] under 1 m/s^2
    YoungFit fit;
};

Settled settle_and_fit(const Rig& rig, const BarSetting& setting)
{
    Settled settled{pbs::settle(rig.cantilever.body.mesh, rig.cantilever.body.held, pbs_options(setting), -pbs::Vec3::UnitZ()), {}, {}};
    settled.displacement = setting.time_step_s * setting.time_step_s * settled.state.displacement;
    settled.fit = fit_young(rig.cantilever, rig.elastic, settled.displacement, 1.0);
    return settled;
}

SagRow sag_row(const Rig& rig, const BarSetting& setting)
{
    const Settled settled = settle_and_fit(rig, setting);
    const analysis::Interval& young_pa = settled.fit.young_pa;
    const double dt_edge = setting.time_step_s / setting.mean_edge_m;
    return {.setting = setting,
            .young_pa = young_pa.estimate,
            .young_low_pa = young_pa.low,
            .young_high_pa = young_pa.high,
            .quality = quality_of(settled.fit.minimum),
            .scaled_young = young_pa.estimate * dt_edge * dt_edge / setting.density_kg_m3 / setting.iterations,
            .tip_sag_over_g_dt2 = mean_sag_m(rig.cantilever, settled.state.displacement),
            .settled = settled.state.converged,
            .residual = settled.state.residual,
            .solver_steps = settled.state.steps};
}

// By Rayleigh's quotient of its own sag, which for a slender cantilever is (12.462 / 12.362)^(1/2) times the first frequency.
double first_frequency_hz(const Rig& rig)
{
    constexpr double quotient = (576.0 / 20.0) * (45.0 / 104.0), first = 12.362363368;  // EI / (density A L^4), both squared
    const pbs::Positions& sag = rig.elastic.displacement;
    const double omega_2 = -rig.cantilever.body.mass_kg.dot(sag.col(2)) / rig.cantilever.body.mass_kg.dot(sag.rowwise().squaredNorm());
    return std::sqrt(omega_2 * first / quotient) / (2.0 * std::numbers::pi);
}

// elastic_hz: first frequency of the elastic bar of 1 Pa.
SwingRow swing_row(const Rig& rig, const BarSetting& setting, double elastic_hz)
{
    const Settled settled = settle_and_fit(rig, setting);
    const double one_per_mille = 2e-3 / mean_sag_m(rig.cantilever, settled.displacement);  // of the bar's 2 m, at the tip
    SwingRow row{.setting = setting};
    row.test = release({rig.cantilever.body.mesh, rig.cantilever.body.held, pbs_options(setting), one_per_mille * settled.displacement,
                        -pbs::Vec3::UnitZ(), rig.cantilever.tip},
                       setting.time_step_s);
    row.young_pa = std::pow(row.test.undamped_hz / elastic_hz, 2);
    row.young_sag_pa = settled.fit.young_pa.estimate;
    row.young_over_sag = row.young_pa / row.young_sag_pa;
    row.expected_over_sag = frequency_over_sag(2.0 * std::numbers::pi * elastic_hz * std::sqrt(row.young_sag_pa) * setting.time_step_s);
    return row;
}

}  // namespace

FitQuality quality_of(const analysis::Minimum& minimum)
{
    return {minimum.value, minimum.rise, analysis::name_of(minimum.outcome), minimum.identifiable()};
}

// For one mode: s of the iterations rests at x = a dt^2 s / (1 - s), so static_rad^2 = (1 - s) / s. In time z = s +- i sqrt(s (1 - s)).
double frequency_over_sag(double static_rad)
{
    const double s = 1.0 / (1.0 + static_rad * static_rad);
    const double swing_rad = std::hypot(std::acos(std::sqrt(s)), std::log(s) / 2.0);  // |log z|: undamped
    return swing_rad * swing_rad / (static_rad * static_rad);
}

nlohmann::json to_json(const SagCase& of)
{
    static const auto fields = OptionFields<SagCase>("sag")
                                   .record("vertices", &SagCase::vertices)
                                   .record("k_stretch", &SagCase::k_stretch)
                                   .record("k_volume", &SagCase::k_volume)
                                   .record("iterations", &SagCase::iterations)
                                   .constant("time_step_s", sag_time_step_s)
                                   .constant("density_kg_m3", density_kg_m3)
                                   .constant("poisson", elastic_poisson)
                                   .complete();
    return fields.json(of);
}

nlohmann::json to_json(const SwingCase& of)
{
    static const auto fields = OptionFields<SwingCase>("swing")
                                   .record("vertices", &SwingCase::vertices)
                                   .record("k_stretch", &SwingCase::k_stretch)
                                   .record("iterations", &SwingCase::iterations)
                                   .record("time_steps_s", &SwingCase::time_steps_s)
                                   .constant("density_kg_m3", density_kg_m3)
                                   .constant("poisson", elastic_poisson)
                                   .complete();
    return fields.json(of);
}

std::string record_sags(const SagCase& of, const std::string& folder)
{
    const Rig rig = make_rig(of.vertices);
    std::vector<SagRow> rows;
    for (const double k_stretch : of.k_stretch)
        for (const double k_volume : of.k_volume)
            for (const int n : of.iterations) rows.push_back(sag_row(rig, setting_of(rig, k_stretch, k_volume, n, sag_time_step_s)));
    table_of(sag_columns, rows).write(analysis::path_in(folder, "sag.csv"));
    return "";
}

std::string record_swings(const SwingCase& of, const std::string& folder)
{
    const Rig rig = make_rig(of.vertices);
    const double elastic_hz = first_frequency_hz(rig);
    std::vector<SwingRow> rows;
    for (const double k_stretch : of.k_stretch)
        for (const int n : of.iterations)
            for (const double dt_s : of.time_steps_s) rows.push_back(swing_row(rig, setting_of(rig, k_stretch, 1.0, n, dt_s), elastic_hz));
    table_of(swing_columns, rows).write(analysis::path_in(folder, "swing.csv"));
    return "";
}

}  // namespace experiments
