#include "experiments/studies/stiffness/stiffness_sweep.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/character/bodies.hpp"

namespace experiments {
namespace {

constexpr double softer_pa = 3.0e4, stiffer_pa = 3.0e5;  // as stiff as few and as many iterations of PBS on the limb

std::vector<LoadedBody> bodies_of(const std::string& body, int vertices)
{
    if (body == "bar") return {hanging_bar(vertices > 0 ? vertices : 1000)};
    const pbs::Character character = pbs::make_character({.body = body, .vertices = vertices, .surface = false});
    return {jiggling_flesh(character, RestOfBody::projected), jiggling_flesh(character, RestOfBody::held)};
}

// Small steps run only where the rest of the body is held: it would be put back once per step, not once per substep. They do not run on the
// bar, whose slowest motion takes more of such steps than the linear solver's Krylov space has.
bool suits(const LoadedBody& body, const StiffnessSetting& setting)
{
    return setting.method != Method::xpbd_small_steps || body.load == "zone_on_held";
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

std::vector<int> iterations_of(const StiffnessSweep& sweep)
{
    if (sweep.varied != Varied::iterations) return {24};
    return sweep.full ? std::vector<int>{3, 6, 12, 24, 48, 96, 192, 384} : std::vector<int>{6, 12, 24, 48};
}

std::vector<double> time_steps_ms_of(const StiffnessSweep& sweep)
{
    if (sweep.varied != Varied::time_step) return {10.0};
    return sweep.full ? std::vector<double>{1.25, 2.5, 5.0, 10.0, 20.0, 40.0} : std::vector<double>{5.0, 10.0, 20.0};
}

// File order, and random orders next to the paper's number of iterations.
int orders_of(const StiffnessSweep& sweep, int iterations)
{
    return sweep.full && sweep.varied == Varied::iterations && iterations >= 12 && iterations <= 48 ? 3 : 1;
}

std::vector<StiffnessSetting> settings_of(const StiffnessSweep& sweep)
{
    std::vector<StiffnessSetting> all, run = materials(sweep.full && sweep.varied == Varied::iterations);
    if (sweep.body == "limb" && sweep.varied != Varied::resolution)  // no theory says what the failing control does on other meshes
        run.push_back({.method = Method::xpbd_forgetting, .young_pa = softer_pa});
    for (StiffnessSetting setting : run)
        for (const int iterations : iterations_of(sweep))
            for (const double time_step_ms : time_steps_ms_of(sweep))
                for (int order = 0; order < orders_of(sweep, iterations); ++order) {
                    setting.iterations = iterations;
                    setting.time_step_ms = time_step_ms;
                    setting.order_seed = order;
                    all.push_back(setting);
                }
    return all;
}

// The solver itself is stepped too at time steps next to the paper's, where the body settles quickly.
bool is_stepped(const StiffnessSweep& sweep, const LoadedBody& body, const StiffnessSetting& setting)
{
    const bool next_to_the_paper = setting.time_step_ms >= 5.0 && setting.time_step_ms <= 20.0;
    const bool quick_to_settle = body.load != "cantilever" && setting.method != Method::xpbd_small_steps;
    const bool wanted = sweep.full || (body.load == "zone" && setting.method == Method::pbs && setting.k_stretch == 0.2);
    return sweep.varied == Varied::time_step && next_to_the_paper && quick_to_settle && wanted;
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
        if (sweep.full && sweep.varied == Varied::resolution) sizes.push_back({vertices * 11 / 10, "tenth_finer"});
    }
    return sizes;
}

}  // namespace

nlohmann::json to_json(const StiffnessSweep& sweep)
{
    static const auto fields = OptionFields<StiffnessSweep>("stiffness")
                                   .record("varied", &StiffnessSweep::varied)
                                   .record("body", &StiffnessSweep::body)
                                   .record("full", &StiffnessSweep::full)
                                   .record("vertices", &StiffnessSweep::vertices)
                                   .derived("settings", [](const StiffnessSweep& of) { return option_json(settings_of(of)); })
                                   .constant("gravity_m_s2", still_gravity_m_s2)
                                   .constant("density_kg_m3", flesh_density_kg_m3)
                                   .complete();
    return fields.json(sweep);
}

std::string record_stiffness(const StiffnessSweep& sweep, const std::string& folder)
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
    table_of(stiffness_columns, rows).write(analysis::path_in(folder, "stiffness.csv"));
    analysis::measurement_table(stiffness_ratios(rows, sweep.varied)).write(analysis::path_in(folder, "measurements.csv"));
    return "";
}

}  // namespace experiments
