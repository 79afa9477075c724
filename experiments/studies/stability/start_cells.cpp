#include "experiments/deformers/registry.hpp"
#include "experiments/studies/stability/cell_table.hpp"
#include "experiments/studies/stability/stability_cells.hpp"

#include <nlohmann/json.hpp>

namespace experiments {
namespace {

void set_poisson(StabilityCell& cell, double poisson)
{
    cell.spec = with_option(cell.spec, "poisson", poisson);
}

const Sweep incompressible{"poisson", "1", {0.499}, {0.49}, set_poisson};

StabilityCell posed(const std::string& kind, bool is_twisted)
{
    StabilityCell cell;
    cell.model = kind;
    cell.spec = default_spec(kind);
    if (is_twisted) cell.disturbance.axis = pbs::Vec3::UnitX();
    return cell;
}

}  // namespace

std::vector<StabilityCell> start_cells(bool full)
{
    std::vector<StabilityCell> cells;
    for (const ComparedKind& compared : compared_kinds()) {
        if (!compared.minimises) continue;
        for (const bool is_twisted : {false, true}) append(cells, cells_of(starts, posed(compared.kind, is_twisted), full));
        const StabilityCell twisted = posed(compared.kind, true);
        append(cells, cells_of_map(starts, incompressible, twisted, full));
        for (const Sweep* sweep : compared.beyond_limits) append(cells, cells_of_map(starts, *sweep, twisted, full));
    }
    return cells;
}

std::vector<StartRow> starts_not_applicable()
{
    std::vector<StartRow> rows;
    for (const ComparedKind& compared : compared_kinds()) {
        if (compared.minimises) continue;
        StartRow row;
        row.body = "limb";
        row.model = compared.kind;
        row.precision = traits_of(default_spec(compared.kind)).precision;
        row.outcome = StartOutcome::not_applicable;
        row.reason = compared.without_start;
        rows.push_back(row);
    }
    return rows;
}

}  // namespace experiments
