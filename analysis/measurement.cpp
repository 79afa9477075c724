#include "analysis/measurement.hpp"

#include <fmt/format.h>

namespace analysis {
namespace {

bool within(const Claim& claim, double value)
{
    return claim.low <= value && value <= claim.high;
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

Extent extent_of(const Claim& claim, const Measurement& measured)
{
    if (!within(claim, measured.value)) return Extent::none;
    return within(claim, measured.low) && within(claim, measured.high) ? Extent::whole : Extent::part;
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
