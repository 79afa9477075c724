// C11: what the stiffness k in [0, 1] comes to: force over displacement of flesh that hangs under gravity, against iterations, time step
// and resolution; of PBS, of PBS with Mueller's exponent, and of XPBD, whose stiffness is a material's, so that the study can be seen to
// see it.
//
//   bar   cantilever             limb, human, ...   the jiggling zone, on what the solver moves, and on the rest of the body held
//
// On the limb XPBD is run once more with its multipliers forgotten in every iteration: a control that has to fail; no part of the claim.
// Judged is the zone on what the solver moves, as the paper runs it; bars and zones on what is held stand beside it ("flesh held").
// Writes DIR/stiffness/{iterations,time_step,resolution}_BODY/stiffness.csv and measurements.csv; DIR/stiffness/stiffness.csv,
// exponents.csv and stiffness.md.
#include "analysis/records/atomic_file.hpp"
#include "analysis/measurement.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/shared/program_claims.hpp"
#include "experiments/studies/stiffness/stiffness_report.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/character/bodies.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr double softer_pa = 3.0e4, stiffer_pa = 3.0e5;  // as stiff as few and as many iterations of PBS on the limb

const std::pair<Varied, const char*> sweeps[] = {
    {Varied::iterations, "iterations"}, {Varied::time_step, "time_step"}, {Varied::resolution, "resolution"}};

std::vector<LoadedBody> bodies_of(const std::string& body, int vertices)
{
    if (body == "bar") return {hanging_bar(vertices > 0 ? vertices : 1000)};
    const pbs::Character character = pbs::make_character({.body = body, .vertices = vertices, .surface = false});
    return {jiggling_flesh(character, RestOfBody::projected), jiggling_flesh(character, RestOfBody::held)};
}

// Small steps only where the rest is held: it would be put back once a step, not once a substep. Not on the bar, whose slowest motion takes
// more of such steps than the linear solver's Krylov space has.
bool suits(const LoadedBody& body, const StiffnessSetting& setting)
{
    return setting.method != Method::xpbd_small_steps || body.load == "zone on held";
}

std::vector<StiffnessSetting> materials(bool full)
{
    std::vector<StiffnessSetting> all;
    for (const double k : full ? std::vector<double>{0.05, 0.2, 0.6, 0.9} : std::vector<double>{0.2, 0.9})
        all.push_back({.method = Method::pbs, .k_stretch = k});
    for (const double k : full ? std::vector<double>{0.2, 0.9} : std::vector<double>{0.2})
        all.push_back({.method = Method::exponent, .k_stretch = k});
    all.push_back({.method = Method::xpbd, .young_pa = softer_pa});
    if (full) all.push_back({.method = Method::xpbd, .young_pa = stiffer_pa});
    all.push_back({.method = Method::xpbd_small_steps, .young_pa = softer_pa});
    return all;
}

struct Sweep {
    Varied varied;
    std::string body;
    bool full = false;
    std::vector<int> vertices = {0};  // 0: the body's own size
};

std::vector<int> iterations_of(const Sweep& sweep)
{
    if (sweep.varied != Varied::iterations) return {24};
    return sweep.full ? std::vector<int>{3, 6, 12, 24, 48, 96, 192, 384} : std::vector<int>{6, 12, 24, 48};
}

std::vector<double> time_steps_ms_of(const Sweep& sweep)
{
    if (sweep.varied != Varied::time_step) return {10.0};
    return sweep.full ? std::vector<double>{1.25, 2.5, 5.0, 10.0, 20.0, 40.0} : std::vector<double>{5.0, 10.0, 20.0};
}

// File order, and beside the paper's number of iterations random orders.
unsigned long orders_of(const Sweep& sweep, int iterations)
{
    return sweep.full && sweep.varied == Varied::iterations && iterations >= 12 && iterations <= 48 ? 3 : 1;
}

bool has_failing_control(const Sweep& sweep)
{
    return sweep.body == "limb" && sweep.varied != Varied::resolution;  // of which theory says nothing
}

std::vector<StiffnessSetting> settings_of(const Sweep& sweep)
{
    std::vector<StiffnessSetting> all, run = materials(sweep.full && sweep.varied == Varied::iterations);
    if (has_failing_control(sweep)) run.push_back({.method = Method::xpbd_forgetting, .young_pa = softer_pa});
    for (StiffnessSetting setting : run)
        for (const int iterations : iterations_of(sweep))
            for (const double time_step_ms : time_steps_ms_of(sweep))
                for (unsigned long order = 0; order < orders_of(sweep, iterations); ++order) {
                    setting.iterations = iterations;
                    setting.time_step_s = 1e-3 * time_step_ms;
                    setting.order_seed = order;
                    all.push_back(setting);
                }
    return all;
}

// By the solver itself too: time steps beside the paper's, of what settles quickly.
bool is_stepped(const Sweep& sweep, const LoadedBody& body, const StiffnessSetting& setting)
{
    const bool beside_the_paper = setting.time_step_s >= 0.005 && setting.time_step_s <= 0.02;
    const bool quick_to_settle = body.load != "cantilever" && setting.method != Method::xpbd_small_steps;
    const bool asked = sweep.full || (body.load == "zone" && setting.method == Method::pbs && setting.k_stretch == 0.2);
    return sweep.varied == Varied::time_step && beside_the_paper && quick_to_settle && asked;
}

struct Size {
    int vertices;
    const char* mesh;
};

std::vector<Size> sizes_of(const Sweep& sweep)
{
    std::vector<Size> sizes;
    for (const int vertices : sweep.vertices) {
        sizes.push_back({vertices, "wanted"});
        if (sweep.full && sweep.varied == Varied::resolution) sizes.push_back({vertices * 11 / 10, "wanted, a tenth finer"});
    }
    return sizes;
}

std::string measure_and_record(const Sweep& sweep, const std::string& folder)
{
    std::vector<StiffnessRow> rows;
    for (const Size& size : sizes_of(sweep))
        for (const LoadedBody& body : bodies_of(sweep.body, size.vertices))
            for (const StiffnessSetting& setting : settings_of(sweep)) {
                if (!suits(body, setting)) continue;
                rows.push_back(linear_stiffness(body, setting));
                rows.back().mesh = size.mesh;
                if (is_stepped(sweep, body, setting)) rows.push_back(stepped_stiffness(body, setting));
            }
    stiffness_table(rows).write((fs::path(folder) / "stiffness.csv").string());
    analysis::measurement_table(stiffness_ratios(rows, sweep.varied)).write((fs::path(folder) / "measurements.csv").string());
    return "";
}

nlohmann::json to_json(const Sweep& sweep)
{
    nlohmann::json settings = nlohmann::json::array(), sizes = nlohmann::json::array();
    for (const StiffnessSetting& setting : settings_of(sweep)) settings.push_back(to_json(setting));
    for (const Size& size : sizes_of(sweep)) sizes.push_back(size.vertices);
    return {{"body", sweep.body},
            {"full", sweep.full},
            {"vertices", sizes},
            {"settings", settings},
            {"gravity_m_s2", still_gravity_m_s2},
            {"density_kg_m3", flesh_density_kg_m3}};
}

StudyRun sweep_run(const Sweep& sweep, double cost_s)
{
    return {.name = fmt::format("{}_{}", sweeps[static_cast<int>(sweep.varied)].second, sweep.body),
            .cost_s = cost_s,
            .work = [sweep](const std::string& folder) { return measure_and_record(sweep, folder); },
            .settings = to_json(sweep)};
}

void plan_body(StudyPlan& plan, const std::string& body, const std::vector<int>& ladder, bool full)
{
    plan.runs.push_back(sweep_run({Varied::iterations, body, full}, full ? 40.0 : 4.0));
    plan.runs.push_back(sweep_run({Varied::time_step, body, full}, full ? 30.0 : 6.0));
    if (!ladder.empty()) plan.runs.push_back(sweep_run({Varied::resolution, body, full, ladder}, full ? 60.0 : 5.0));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan_body(plan, "bar", full ? std::vector<int>{300, 600, 1200, 2400, 4800} : std::vector<int>{300, 600, 1200}, full);
    plan_body(plan, "limb", full ? std::vector<int>{300, 600, 1200, 2400, 4800, 9600, 20000} : std::vector<int>{300, 600, 1200, 2400},
              full);
    for (const std::string& body : installed_bodies(plan.left_out)) {
        std::vector<int> ladder;
        if (body == "human") ladder = full ? std::vector<int>{1200, 2400, 4800, 9600} : std::vector<int>{1200, 2400, 4800};
        plan_body(plan, body, ladder, full);
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<SweptRows> swept;
    std::vector<StiffnessRow> all;
    for (const auto& [varied, name] : sweeps) {
        std::vector<StiffnessRow> rows;
        for (const std::string& run : finished.folders) {
            if (!fs::path(run).filename().string().starts_with(name)) continue;
            const auto of_run = stiffness_rows(analysis::read_csv((fs::path(run) / "stiffness.csv").string()));
            rows.insert(rows.end(), of_run.begin(), of_run.end());
        }
        all.insert(all.end(), rows.begin(), rows.end());
        swept.emplace_back(varied, std::move(rows));
    }
    const analysis::Claim& claim = claim_named("C11");
    finished.write("stiffness.csv", stiffness_table(all));
    finished.write("exponents.csv", exponents_table(swept));
    finished.write("stiffness.md", stiffness_markdown(swept) + control_markdown(swept, claim));
    return {stiffness_text(swept) + control_text(swept, claim), !finished.none()};
}

}  // namespace

Study stiffness_study()
{
    return {"stiffness", plan, quick_and_full, conclude};
}

}  // namespace experiments
