#include "experiments/studies/stiffness/stiffness_row.hpp"

#include "experiments/studies/stiffness/resting_body.hpp"
#include "pbs/geometry/input_error.hpp"

namespace experiments {
namespace {

constexpr Method methods[] = {Method::pbs, Method::exponent, Method::xpbd, Method::xpbd_small_steps, Method::xpbd_forgetting};

StiffnessRow row_of(const LoadedBody& body, const StiffnessSetting& setting)
{
    StiffnessRow row;
    row.body = body.name;
    row.load = body.load;
    row.vertices = static_cast<int>(body.mesh.rest.rows());
    row.edges = body.edges;
    row.tets = static_cast<int>(body.mesh.tets.rows());
    row.setting = setting;
    return row;
}

Method method_named(const std::string& name)
{
    for (const Method method : methods)
        if (name == name_of(method)) return method;
    throw pbs::InputError("stiffness.csv", 0, "method", name, "expected pbs, exponent, xpbd, xpbd_small_steps or xpbd_forgetting");
}

StiffnessSetting setting_at(const analysis::CsvTable& table, int row)
{
    StiffnessSetting setting;
    setting.method = method_named(table.text_at(row, "method"));
    setting.k_stretch = table.number(row, "k_stretch");
    setting.young_pa = table.number(row, "young_pa");
    setting.iterations = static_cast<int>(table.integer(row, "iterations"));
    setting.time_step_s = 1e-3 * table.number(row, "time_step_ms");
    setting.order_seed = static_cast<unsigned long>(table.integer(row, "order_seed"));
    return setting;
}

}  // namespace

StiffnessRow linear_stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    const RestingState rest = rest_near_rest(body, setting);
    StiffnessRow row = row_of(body, setting);
    row.force_n = weight_n(body, 1.0);
    row.stiffness_n_m = effective_stiffness_n_m(body, rest.displacement, 1.0);
    row.converged = rest.converged;
    row.steps = rest.steps;
    return row;
}

StiffnessRow stepped_stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    const SteppedBody still = step_until_still(body, setting, still_gravity_m_s2);
    StiffnessRow row = row_of(body, setting);
    row.by = "stepped";
    row.force_n = weight_n(body, still_gravity_m_s2);
    row.stiffness_n_m = effective_stiffness_n_m(body, still.displacement, still_gravity_m_s2);
    row.converged = still.converged;
    row.steps = still.steps;
    return row;
}

analysis::CsvTable stiffness_table(const std::vector<StiffnessRow>& rows)
{
    analysis::CsvTable table({"body", "load", "vertices", "edges", "tets", "mesh", "method", "k_stretch", "young_pa", "iterations",
                              "time_step_ms", "order_seed", "by", "force_n", "stiffness_n_m", "converged", "steps"});
    for (const StiffnessRow& row : rows) {
        const StiffnessSetting& set = row.setting;
        table.add_row({row.body, row.load, row.vertices, row.edges, row.tets, row.mesh, std::string(name_of(set.method)), set.k_stretch,
                       set.young_pa, set.iterations, 1e3 * set.time_step_s, static_cast<int>(set.order_seed), row.by, row.force_n,
                       row.stiffness_n_m, row.converged ? 1 : 0, row.steps});
    }
    return table;
}

std::vector<StiffnessRow> stiffness_rows(const analysis::CsvTable& table)
{
    std::vector<StiffnessRow> rows;
    for (int i = 0; i < table.rows(); ++i) {
        StiffnessRow row;
        row.body = table.text_at(i, "body");
        row.load = table.text_at(i, "load");
        row.vertices = static_cast<int>(table.integer(i, "vertices"));
        row.edges = static_cast<int>(table.integer(i, "edges"));
        row.tets = static_cast<int>(table.integer(i, "tets"));
        row.mesh = table.text_at(i, "mesh");
        row.setting = setting_at(table, i);
        row.by = table.text_at(i, "by");
        row.force_n = table.number(i, "force_n");
        row.stiffness_n_m = table.number(i, "stiffness_n_m");
        row.converged = table.integer(i, "converged") != 0;
        row.steps = static_cast<int>(table.integer(i, "steps"));
        rows.push_back(row);
    }
    return rows;
}

}  // namespace experiments
