#include "analysis/measurement.hpp"

#include "analysis/records/optional_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

const Columns<Measurement>& measurement_columns()
{
    static const Columns<Measurement> columns =
        Columns<Measurement>{{"claim", &Measurement::claim, "", "id of the claim"},
                             {"quantity", &Measurement::quantity, "", "what is measured"}} +
        within(&Measurement::of, case_key_columns()) +
        Columns<Measurement>{{"value", &Measurement::value, "", "in `unit`"},
                             {"low", &Measurement::low, "", "lower end of its interval"},
                             {"high", &Measurement::high, "", "upper end of its interval"},
                             {"unit", &Measurement::unit, "", "unit of value, low and high"}} +
        optional(Columns<Measurement>{
            column_with_empty(Limit::none, "limit", &Measurement::limit, "", "how the value limits the quantity"),
            column_with_empty(0, "n", &Measurement::n, "", "settings, cells or comparisons from which the value is computed"),
            column_with_empty(0, "not_reached", &Measurement::not_reached, "", "how many of these reach the tolerance from no guess")});
    return columns;
}

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
    return rows_of(measurement_columns(), read_csv(csv));
}

CsvTable measurement_table(const std::vector<Measurement>& measurements)
{
    return table_of(used_columns(measurement_columns(), measurements), measurements);
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
