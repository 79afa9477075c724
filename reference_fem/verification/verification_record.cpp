#include "reference_fem/verification/verification_record.hpp"

#include "analysis/records/record_files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <limits>

namespace reference_fem {
namespace {

nlohmann::json to_json(const std::optional<double>& value)
{
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

std::optional<double> optional_number(const nlohmann::json& json, const char* key)
{
    return json.at(key).is_null() ? std::optional<double>() : json.at(key).get<double>();
}

// JSON knows no nan: null.
double number_or_nan(const nlohmann::json& json, const char* key)
{
    return optional_number(json, key).value_or(std::nan(""));
}

using analysis::Columns;
using analysis::within;

const Columns<RowQuantity> quantity_columns = {
    {"quantity", &RowQuantity::key, "", "what is computed, as an identifier"},
    {"setting", &RowQuantity::setting, "", "an identifier that distinguishes rows with the same quantity"},
    {"description", &RowQuantity::description, "", "the same in words, with the settings that it belongs to"}};
const Columns<RowElements> element_columns = {
    {"element_order", &RowElements::order, "", "1 linear, 2 quadratic; empty in a row without finite elements"},
    {"formulation", &RowElements::formulation, "",
     "displacement, mean_dilatation or taylor_hood; without finite elements pbs, volume_constraints, one_point or two_grids"}};
const Columns<RowMaterial> material_columns = {{"material", &RowMaterial::law, "", "constitutive law, as an identifier"},
                                               {"poisson", &RowMaterial::poisson, "", "Poisson's ratio, of an elastic law"}};
const Columns<VerificationRow> bound_columns = {{"low", &VerificationRow::low, "", "lower bound of the value"},
                                                {"high", &VerificationRow::high, "", "upper bound of the value"},
                                                {"bound_from", &VerificationRow::bound_from, "", "where the bounds are from"},
                                                {"observed_order", &VerificationRow::observed_order, "", "observed order of convergence"},
                                                {"expected_order", &VerificationRow::expected_order, "", "order of convergence by theory"},
                                                {"note", &VerificationRow::note, "", "remark"}};

std::string verdict_of(const VerificationRow& row)
{
    const std::optional<bool> held = holds(row);
    return !held ? "" : *held ? "yes" : "no";
}

std::string number(const std::optional<double>& value, const char* format = "{:.6g}")
{
    return value ? fmt::format(fmt::runtime(format), *value) : "";
}

std::string bounds_text(const VerificationRow& row)
{
    return row.low || row.high ? fmt::format("{} to {}", number(row.low, "{:.4g}"), number(row.high, "{:.4g}")) : "";
}

std::string order_text(const VerificationRow& row)
{
    if (!row.observed_order) return "";
    return number(row.observed_order, "{:.2f}") + (row.expected_order ? " (" + number(row.expected_order, "{:.3g}") + ")" : "");
}

// Sources and origins of bounds, each once, in the order of the rows.
std::vector<std::string> footnotes(const VerificationRows& rows)
{
    std::vector<std::string> notes;
    for (const VerificationRow& row : rows)
        for (const std::string& note : {row.source, row.bound_from})
            if (!note.empty() && !std::count(notes.begin(), notes.end(), note)) notes.push_back(note);
    return notes;
}

std::string marks(const VerificationRow& row, const std::vector<std::string>& notes)
{
    std::string text;
    for (const std::string& note : {row.source, row.bound_from})
        if (!note.empty())
            text += fmt::format("{}{}", text.empty() ? "" : ", ", std::find(notes.begin(), notes.end(), note) - notes.begin() + 1);
    return text;
}

std::string markdown(const VerificationRows& rows)
{
    const std::vector<std::string> notes = footnotes(rows);
    std::string text =
        "| problem | quantity | elements | material | mesh | dofs | value | reference | unit | difference [%] | order (theory) | bounds | "
        "holds | notes |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const VerificationRow& row : rows)
        text +=
            fmt::format("| {} | {} | {} | {} | {} | {} | {:.6g} | {} | {} | {} | {} | {} | {} | {} |\n", row.problem,
                        row.quantity.description + (row.note.empty() ? "" : " (" + row.note + ")"), row.elements.text(),
                        row.material.text(), row.mesh, row.dofs, row.value, row.reference == 0.0 ? "0" : number(row.reference), row.unit,
                        number(difference_pct(row), "{:+.3g}"), order_text(row), bounds_text(row), verdict_of(row), marks(row, notes));
    text += "\n";
    for (std::size_t k = 0; k < notes.size(); ++k) text += fmt::format("{}. {}\n", k + 1, notes[k]);
    return text;
}

// The values that a quantity had.
struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    void add(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    std::string text(const char* format) const
    {
        if (low > high) return "";
        return number(low, format) + (low < high ? " to " + number(high, format) : "");
    }
};

struct ProblemSummary {
    int judged = 0, held = 0, without_bounds = 0;
    Range difference_pct, order_difference;  // of the rows that are judged
    std::string failing;                     // one line per row
};

ProblemSummary summarise(const std::string& problem, const VerificationRows& rows)
{
    ProblemSummary summary;
    for (const VerificationRow& row : rows) {
        if (row.problem != problem) continue;
        const std::optional<bool> row_holds = holds(row);
        if (!row_holds) {
            ++summary.without_bounds;
            continue;
        }
        ++summary.judged;
        summary.held += *row_holds;
        if (const auto difference = difference_pct(row)) summary.difference_pct.add(*difference);
        if (row.expected_order && row.observed_order) summary.order_difference.add(*row.observed_order - *row.expected_order);
        if (!*row_holds)
            summary.failing +=
                fmt::format("  does not hold: {}, {}, {}, {}: {} {}, expected {} {}\n", row.quantity.description, row.elements.text(),
                            row.material.text(), row.mesh, number(row.value), row.unit, bounds_text(row), order_text(row));
    }
    return summary;
}

}  // namespace

std::string RowElements::text() const
{
    if (!order) return formulation;
    return fmt::format("P{}{}", *order, formulation == "displacement" ? "" : " " + formulation);
}

std::string RowMaterial::text() const
{
    return law + (poisson ? fmt::format(", poisson {:.6g}", *poisson) : "");
}

std::optional<double> difference_pct(const VerificationRow& row)
{
    if (row.reference == 0.0) return std::nullopt;
    return 100.0 * (row.value - row.reference) / std::abs(row.reference);
}

std::optional<bool> holds(const VerificationRow& row)
{
    if (!row.low && !row.high && !row.expected_order) return std::nullopt;
    bool all = std::isfinite(row.value);
    if (row.low) all &= row.value >= *row.low;
    if (row.high) all &= row.value <= *row.high;
    if (row.expected_order) all &= row.observed_order && std::abs(*row.observed_order - *row.expected_order) <= order_tolerance;
    return all;
}

nlohmann::json to_json(const VerificationRow& row)
{
    const std::optional<bool> held = holds(row);
    return {{"problem", row.problem},
            {"quantity", row.quantity.key},
            {"setting", row.quantity.setting},
            {"description", row.quantity.description},
            {"element_order", row.elements.order ? nlohmann::json(*row.elements.order) : nlohmann::json(nullptr)},
            {"formulation", row.elements.formulation},
            {"material", row.material.law},
            {"poisson", to_json(row.material.poisson)},
            {"mesh", row.mesh},
            {"h_m", row.h_m},
            {"dofs", row.dofs},
            {"value", row.value},
            {"reference", row.reference},
            {"unit", row.unit},
            {"source", row.source},
            {"difference_pct", to_json(difference_pct(row))},
            {"low", to_json(row.low)},
            {"high", to_json(row.high)},
            {"bound_from", row.bound_from},
            {"observed_order", to_json(row.observed_order)},
            {"expected_order", to_json(row.expected_order)},
            {"note", row.note},
            {"holds", held ? nlohmann::json(*held) : nlohmann::json(nullptr)}};
}

VerificationRow verification_row(const nlohmann::json& json)
{
    VerificationRow row;
    row.problem = json.at("problem");
    row.quantity = {json.at("quantity"), json.at("description"), json.at("setting")};
    if (!json.at("element_order").is_null()) row.elements.order = json.at("element_order").get<int>();
    row.elements.formulation = json.at("formulation");
    row.material = {json.at("material"), optional_number(json, "poisson")};
    row.mesh = json.at("mesh");
    row.h_m = json.at("h_m");
    row.dofs = json.at("dofs");
    row.value = number_or_nan(json, "value");
    row.reference = number_or_nan(json, "reference");
    row.unit = json.at("unit");
    row.source = json.at("source");
    row.low = optional_number(json, "low");
    row.high = optional_number(json, "high");
    row.bound_from = json.at("bound_from");
    row.observed_order = optional_number(json, "observed_order");
    row.expected_order = optional_number(json, "expected_order");
    row.note = json.at("note");
    return row;
}

const analysis::Columns<RecordedRow>& verification_columns()
{
    static const Columns<VerificationRow> compared =
        Columns<VerificationRow>{{"problem", &VerificationRow::problem, "", "name of the problem"}} +
        within(&VerificationRow::quantity, quantity_columns) + within(&VerificationRow::elements, element_columns) +
        within(&VerificationRow::material, material_columns) +
        Columns<VerificationRow>{{"mesh", &VerificationRow::mesh, "", "the mesh in words"},
                                 {"h_m", &VerificationRow::h_m, "m", "size of its elements"},
                                 {"dofs", &VerificationRow::dofs, "", "degrees of freedom"},
                                 {"value", &VerificationRow::value, "", "computed value, in the row's unit"},
                                 {"reference", &VerificationRow::reference, "", "value that it is compared with, in the row's unit"},
                                 {"unit", &VerificationRow::unit, "", "unit of both"},
                                 {"source", &VerificationRow::source, "", "where the reference is from"}};
    static const Columns<RecordedRow> all =
        within(&RecordedRow::row, compared) +
        Columns<RecordedRow>{{"difference_pct", &RecordedRow::difference_pct, "%", "difference of the value from the reference"}} +
        within(&RecordedRow::row, bound_columns) +
        Columns<RecordedRow>{{"holds", &RecordedRow::holds, "", "yes, no, or empty where the row has no bounds"}};
    return all;
}

void write_verification_record(const std::string& folder, const VerificationRows& rows)
{
    nlohmann::json json = {{"schema", 3}, {"order_tolerance", order_tolerance}, {"rows", nlohmann::json::array()}};
    for (const VerificationRow& row : rows) json["rows"].push_back(to_json(row));
    std::vector<RecordedRow> recorded;
    for (const VerificationRow& row : rows) recorded.push_back({row, difference_pct(row), verdict_of(row)});
    const std::filesystem::path path(folder);
    analysis::write_text_atomically((path / "verification.csv").string(), table_of(verification_columns(), recorded).text());
    analysis::write_text_atomically((path / "verification.json").string(), json.dump(2) + "\n");
    analysis::write_text_atomically((path / "verification.md").string(), markdown(rows));
}

std::string verification_table(const VerificationRows& rows)
{
    constexpr auto line = "{:<30} {:>8} {:>14}   {:<22} {:<18}\n";
    std::string text = fmt::format(line, "problem", "hold", "without bounds", "difference [%]", "order less theory");
    std::vector<std::string> problems;
    for (const VerificationRow& row : rows)
        if (!std::count(problems.begin(), problems.end(), row.problem)) problems.push_back(row.problem);
    int judged = 0, held = 0;
    for (const std::string& problem : problems) {
        const ProblemSummary summary = summarise(problem, rows);
        judged += summary.judged;
        held += summary.held;
        text += fmt::format(line, problem, fmt::format("{}/{}", summary.held, summary.judged), summary.without_bounds,
                            summary.difference_pct.text("{:+.3g}"), summary.order_difference.text("{:+.2f}")) +
                summary.failing;
    }
    return text + fmt::format("{} of {} rows hold; {} more have no bounds\n", held, judged, rows.size() - judged);
}

}  // namespace reference_fem
