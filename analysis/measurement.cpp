#include "analysis/measurement.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace analysis {
namespace {

constexpr std::array limit_names = {"", "at_least", "at_most", "more_than"};

Limit limit_at(const CsvTable& table, int row, const std::string& csv)
{
    if (!table.has_column("limit")) return Limit::none;
    const std::string& name = table.text_at(row, "limit");
    const auto found = std::find(limit_names.begin(), limit_names.end(), name);
    if (found == limit_names.end()) throw pbs::InputError(csv, 0, "limit", name, "expected at_least, at_most, more_than or an empty cell");
    return static_cast<Limit>(found - limit_names.begin());
}

int count_at(const CsvTable& table, int row, const char* column)
{
    const bool empty = !table.has_column(column) || table.text_at(row, column).empty();
    return empty ? 0 : static_cast<int>(table.integer(row, column));
}

// A column that is written only if some row has a value for it.
struct OptionalColumn {
    const char* name;
    CsvTable::Cell (*cell)(const Measurement&);

    bool is_used(const std::vector<Measurement>& measurements) const
    {
        return std::any_of(measurements.begin(), measurements.end(),
                           [&](const Measurement& measured) { return cell(measured).kind != CsvTable::Cell::Kind::nothing; });
    }
};

CsvTable::Cell count_cell(int count)
{
    if (count == 0) return std::nullopt;
    return count;
}

constexpr OptionalColumn optional_columns[] = {
    {"limit",
     [](const Measurement& measured) {
         return measured.limit == Limit::none ? CsvTable::Cell(std::nullopt) : CsvTable::Cell(name_of(measured.limit));
     }},
    {"n", [](const Measurement& measured) { return count_cell(measured.n); }},
    {"not_reached", [](const Measurement& measured) { return count_cell(measured.not_reached); }}};

bool within(const QuantityBound& bound, double value)
{
    return bound.low <= value && value <= bound.high;
}

bool is_of_a_metric(const Claim& claim, const Measurement& measured)
{
    return measured.claim == claim.id && std::count(claim.metrics.begin(), claim.metrics.end(), measured.quantity) > 0;
}

}  // namespace

std::vector<Measurement> measurements(const std::string& csv)
{
    const CsvTable table = read_csv(csv);
    std::vector<Measurement> all;
    for (int row = 0; row < table.rows(); ++row)
        all.push_back({.claim = table.text_at(row, "claim"),
                       .quantity = table.text_at(row, "quantity"),
                       .of = case_key(table, row),
                       .value = table.number(row, "value"),
                       .low = table.number(row, "low"),
                       .high = table.number(row, "high"),
                       .unit = table.text_at(row, "unit"),
                       .limit = limit_at(table, row, csv),
                       .n = count_at(table, row, "n"),
                       .not_reached = count_at(table, row, "not_reached")});
    return all;
}

CsvTable measurement_table(const std::vector<Measurement>& measurements)
{
    std::vector<const CaseKey*> keys;
    for (const Measurement& measured : measurements) keys.push_back(&measured.of);
    const auto fields = used_fields(keys);
    std::vector<std::string> columns = {"claim", "quantity"};
    for (const CaseKeyField* field : fields) columns.emplace_back(field->name);
    columns.insert(columns.end(), {"value", "low", "high", "unit"});
    for (const OptionalColumn& column : optional_columns)
        if (column.is_used(measurements)) columns.emplace_back(column.name);
    CsvTable table(columns);
    for (const Measurement& m : measurements) {
        std::vector<CsvTable::Cell> cells = {m.claim, m.quantity};
        for (const CaseKeyField* field : fields) cells.push_back(cell_of(*field, m.of));
        cells.insert(cells.end(), {CsvTable::Cell(m.value), CsvTable::Cell(m.low), CsvTable::Cell(m.high), CsvTable::Cell(m.unit)});
        for (const OptionalColumn& column : optional_columns)
            if (column.is_used(measurements)) cells.push_back(column.cell(m));
        table.add_row(cells);
    }
    return table;
}

const char* name_of(Limit limit)
{
    return limit_names[static_cast<std::size_t>(limit)];
}

bool is_judged(const Claim& claim, const Measurement& measured)
{
    return is_of_a_metric(claim, measured) && matches(measured.of, claim.of);
}

bool is_control(const Claim& claim, const Measurement& measured)
{
    return is_of_a_metric(claim, measured) && !matches(measured.of, claim.of);
}

QuantityBound bound_of(const Claim& claim, const std::string& quantity)
{
    const auto found =
        std::find_if(claim.bounds.begin(), claim.bounds.end(), [&](const auto& bound) { return bound.quantity == quantity; });
    return found == claim.bounds.end() ? QuantityBound{quantity, claim.low, claim.high} : *found;
}

Extent extent_of(const Claim& claim, const Measurement& measured)
{
    const QuantityBound bound = bound_of(claim, measured.quantity);
    if (!within(bound, measured.value)) return Extent::none;
    return within(bound, measured.low) && within(bound, measured.high) ? Extent::whole : Extent::part;
}

std::string bound_text(const QuantityBound& bound)
{
    if (bound.low == bound.high) return fmt::format("{:.4g}", bound.low);
    if (bound.high >= open_end) return fmt::format("{:.4g} or more", bound.low);
    if (std::isinf(bound.low)) return fmt::format("{:.4g} or less", bound.high);
    return fmt::format("{:.4g} to {:.4g}", bound.low, bound.high);
}

}  // namespace analysis
