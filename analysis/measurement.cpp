#include "analysis/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

bool within(const QuantityBound& bound, double value)
{
    return bound.low <= value && value <= bound.high;
}

}  // namespace

std::vector<Measurement> measurements(const std::string& csv)
{
    const CsvTable table = read_csv(csv);
    std::vector<Measurement> all;
    for (int row = 0; row < table.rows(); ++row)
        all.push_back({table.text_at(row, "claim"), table.text_at(row, "quantity"), table.text_at(row, "of"), table.number(row, "value"),
                       table.number(row, "low"), table.number(row, "high"), table.text_at(row, "unit")});
    return all;
}

CsvTable measurement_table(const std::vector<Measurement>& measurements)
{
    CsvTable table({"claim", "quantity", "of", "value", "low", "high", "unit"});
    for (const Measurement& m : measurements) table.add_row({m.claim, m.quantity, m.of, m.value, m.low, m.high, m.unit});
    return table;
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
    constexpr double open_end = 1e9;  // what claims.toml writes where a bound has one side only
    if (bound.low == bound.high) return fmt::format("{:.4g}", bound.low);
    if (bound.high >= open_end) return fmt::format("{:.4g} or more", bound.low);
    if (std::isinf(bound.low)) return fmt::format("{:.4g} or less", bound.high);
    return fmt::format("{:.4g} to {:.4g}", bound.low, bound.high);
}

std::string figure_text(const Measurement& measured)
{
    return fmt::format("{:.3g}{}", measured.value, measured.unit == "1" ? "" : " " + measured.unit);
}

std::string interval_text(const Measurement& measured)
{
    return measured.low == measured.high ? "" : fmt::format("[{:.3g}, {:.3g}]", measured.low, measured.high);
}

}  // namespace analysis
