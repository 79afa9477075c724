#include "analysis/records/table_comparison.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

namespace analysis {
namespace {

using ColumnNames = std::vector<std::string_view>;

bool is_among(const ColumnNames& names, std::string_view name)
{
    return std::ranges::find(names, name) != names.end();
}

// Numbers that are settings, in every table except where `exceptions` has another kind.
const ColumnNames settings = {"motion",          "pose",           "clip",          "time_s",
                              "angle_deg",       "frame",          "vertices",      "vertices_to",
                              "k_stretch",       "k_stretch_to",   "k_volume",      "k_bind",
                              "young_pa",        "iterations",     "iterations_to", "iteration",
                              "time_step_s",     "time_step_to_s", "time_step_ms",  "masses",
                              "own_mesh",        "order_seed",     "second_value",  "setting_value",
                              "spring_factor",   "core_radius",    "poisson",       "budget_ms",
                              "refinements",     "element_order",  "h_m",           "rayleigh_stiffness_s",
                              "most_iterations", "bound",          "density_kg_m3"};

// Texts that are results.
const ColumnNames results = {
    "outcome", "remark", "reason", "failure", "note",       "verdict_flips",       "holds_a",
    "holds_b", "holds",  "limit",  "key",     "bound_from", "undisturbed_at_rest", "further_keys"};

// Results that differ from machine to machine and from run to run, and are not compared.
const ColumnNames of_the_machine = {"ms",      "ms_median", "ms_p95",    "cpu_s",    "wall_s", "solve_s",
                                    "seconds", "threads",   "cpu_model", "set_up_s", "rounds"};
const ColumnNames parts_of_times = {"_ms", "frames_per_s", "start_s_", "peak_mb", "shared_objects", "speedup"};

struct Exception {
    std::string_view file;
    ColumnNames settings, results, not_compared;
};
const std::vector<Exception> exceptions = {
    {"metrics.csv", {}, {}, {"frame"}},  // a slower rate numbers the same times in another way
    {"cells.csv", {"value", "unit"}, {}, {}},     {"targets.csv", {}, {"iterations"}, {"limit"}},
    {"rates.csv", {}, {}, {"reference"}},         {"references.csv", {}, {}, {"from_kept_m"}},
    {"verification.csv", {}, {"reference"}, {}},  {"sag.csv", {}, {"young_pa"}, {}},
    {"correctives.csv", {}, {}, {"from_kept_m"}},
};

constexpr const char* printed_values = "printed.csv";

const Exception& exception_of(const std::string& file)
{
    static const Exception none = {};
    const auto found = std::ranges::find(exceptions, file, &Exception::file);
    return found == exceptions.end() ? none : *found;
}

bool is_a_time(std::string_view name)
{
    return is_among(of_the_machine, name) || std::ranges::any_of(parts_of_times, [&](std::string_view part) {
               return name.find(part) != std::string_view::npos;
           });
}

std::optional<double> number_in(const std::string& cell)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

// How many cells of a column are numbers, and how many are texts. Empty cells are neither.
struct CellKinds {
    int numbers = 0, texts = 0;
};

CellKinds kinds_of(const CsvTable& table, const std::string& column)
{
    CellKinds kinds;
    for (int row = 0; row < table.rows(); ++row)
        if (const std::string& cell = table.text_at(row, column); !cell.empty())
            ++(number_in(cell) ? kinds.numbers : kinds.texts);
    return kinds;
}

void refuse_decimal_commas(const CsvTable& table, const std::string& column)
{
    for (int row = 0; row < table.rows(); ++row) {
        std::string cell = table.text_at(row, column);
        if (std::ranges::count(cell, ',') != 1) continue;
        std::ranges::replace(cell, ',', '.');
        if (number_in(cell)) table.refuse(row, column, "expected a decimal point instead of a comma");
    }
}

// A column of texts, by most of its cells: a single text among numbers is a result that differs. InputError for decimal
// commas where one of the tables has numbers.
bool is_of_texts(const CsvTable& first, const CsvTable& second, const std::string& column)
{
    const CellKinds one = kinds_of(first, column), other = kinds_of(second, column);
    if (one.texts > 0 && other.numbers > 0) refuse_decimal_commas(first, column);
    if (other.texts > 0 && one.numbers > 0) refuse_decimal_commas(second, column);
    return one.texts + other.texts > one.numbers + other.numbers;
}

// The columns of both tables: by which rows are found, and which are compared.
struct Shared {
    std::vector<std::string> settings, results;
};

bool is_empty(const CsvTable& table, const std::string& column)
{
    for (int row = 0; row < table.rows(); ++row)
        if (!table.text_at(row, column).empty()) return false;
    return true;
}

Shared shared_columns(const std::string& file, const CsvTable& first, const CsvTable& second, const ComparedAs& as)
{
    const Exception& own = exception_of(file);
    Shared shared;
    for (const std::string& column : first.columns()) {
        if (!second.has_column(column) || is_among(own.not_compared, column)) continue;
        const bool is_text = !is_a_time(column) && is_of_texts(first, second, column);
        const bool is_setting =
            is_among(own.settings, column) ||
            (!is_among(own.results, column) && (is_among(settings, column) || (is_text && !is_among(results, column))));
        if (is_setting)
            shared.settings.push_back(column);
        else if (!is_a_time(column) && !(as.second_is_part && is_empty(second, column)))
            shared.results.push_back(column);
    }
    return shared;
}

std::vector<std::string> columns_without(const CsvTable& table, const CsvTable& other)
{
    std::vector<std::string> columns;
    std::ranges::copy_if(table.columns(), std::back_inserter(columns),
                         [&](const std::string& column) { return !other.has_column(column); });
    return columns;
}

// Six digits, as in records that are rounded.
std::string setting_text(const std::string& cell)
{
    const std::optional<double> value = number_in(cell);
    if (!value) return cell;
    std::array<char, 32> text{};
    return {text.data(),
            std::to_chars(text.data(), text.data() + text.size(), *value, std::chars_format::general, 6).ptr};
}

std::string settings_of(const CsvTable& table, int row, const std::vector<std::string>& columns)
{
    std::string text;
    for (const std::string& column : columns) {
        const std::string& cell = table.text_at(row, column);
        if (cell.empty()) continue;
        text += (text.empty() ? "" : ", ") + (number_in(cell) ? column + " " : "") + setting_text(cell);
    }
    return text;
}

// Rows with the same settings follow each other in the same order.
std::map<std::pair<std::string, int>, int> rows_by_settings(const CsvTable& table,
                                                            const std::vector<std::string>& columns)
{
    std::map<std::string, int> counts;
    std::map<std::pair<std::string, int>, int> rows;
    for (int row = 0; row < table.rows(); ++row) {
        const std::string text = settings_of(table, row, columns);
        rows.emplace(std::pair(text, counts[text]++), row);
    }
    return rows;
}

std::string cell_or_nothing(const CsvTable& table, int row, const std::string& column)
{
    return table.has_column(column) ? table.text_at(row, column) : "";
}

bool is_by_finite_elements(const std::string& file, const CsvTable& table, int row, const std::string& column)
{
    if (file == printed_values) return false;
    for (const char* part : {"error", "reference", "difference", "distance", "energy", "det_f", "share_low", "skin_mm"})
        if (column.find(part) != std::string::npos) return true;
    for (const char* named : {"reference", "member", "problem", "attachment"})
        if (!cell_or_nothing(table, row, named).empty()) return true;
    for (const char* named : {"deformer", "method", "model"})
        for (const char* beginning : {"fem", "nh_", "linear", "corotational", "neo_hookean", "flesh"})
            if (cell_or_nothing(table, row, named).starts_with(beginning)) return true;
    const std::string quantity = cell_or_nothing(table, row, "quantity");
    return quantity.find("reference") != std::string::npos || quantity.find("error") != std::string::npos;
}

bool is_by_minimisation(const std::string& method)
{
    const ColumnNames minimisers = {"quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean", "projective_dynamics"};
    return is_among(minimisers, method);
}

// The absolute tolerance of a number of this row.
double tolerance_of(const std::string& file, const CsvTable& table, int row, const std::string& column, double value)
{
    if (file == "metrics.csv" && column.ends_with("_pct")) return same_frame_points;
    if (file == "errors.csv") {  // of work_precision, whose methods compute in single precision
        const std::optional<double> points = number_in(cell_or_nothing(table, row, "smooth_pct"));
        if (!is_by_minimisation(cell_or_nothing(table, row, "method")) || !points)
            return same_in_single * std::abs(value);
        // by the same displacement
        return column == "skin_mm" ? same_minimum_points / *points * std::abs(value) : same_minimum_points;
    }
    const std::string quantity = cell_or_nothing(table, row, "quantity");
    const bool is_single = cell_or_nothing(table, row, "precision") == "f32";
    // that solve one system
    const bool is_of_two_programs = quantity == "largest_node_difference" && column == "value";
    const bool is_by_elements = !is_of_two_programs && is_by_finite_elements(file, table, row, column);
    const double relative = is_single ? same_in_single : is_by_elements ? same_by_finite_elements : same_in_double;
    // The drift of a conserved quantity, the error of a formula and the difference of two programs are rounding errors
    // themselves, relative to 1.
    const bool is_rounding =
        file == printed_values || is_of_two_programs || quantity.find("drift") != std::string::npos;
    return relative * (is_rounding ? std::max(1.0, std::abs(value)) : std::abs(value));
}

constexpr int rounded_digits = 6;

int significant_digits(const std::string& cell)
{
    int digits = 0;
    for (const char c : cell.substr(0, cell.find_first_of("eE")))
        if (c >= '0' && c <= '9' && (digits > 0 || c != '0')) ++digits;
    return digits;
}

// Half a unit of the last digit, where one of the cells has six digits and the other has more.
double rounding_of(const std::string& one, const std::string& other, double value)
{
    const auto [fewer, more] = std::minmax({significant_digits(one), significant_digits(other)});
    if (fewer > rounded_digits || more <= rounded_digits || value == 0.0) return 0.0;
    return 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(value))) - (rounded_digits - 1)) * (1.0 + 1e-9);
}

enum class Agreement { equal, within, differing };

Agreement agreement(const std::string& first, const std::string& second, double tolerance, bool is_rounded)
{
    if (first == second) return Agreement::equal;
    const std::optional<double> one = number_in(first), other = number_in(second);
    if (one && other && std::isnan(*one) && std::isnan(*other)) return Agreement::equal;  // also -nan, as x86 prints it
    if (!one || !other || !std::isfinite(*one) || !std::isfinite(*other)) return Agreement::differing;
    const double apart = std::abs(*one - *other), rounding = is_rounded ? rounding_of(first, second, *one) : 0.0;
    if (apart <= rounding) return Agreement::equal;
    return apart <= tolerance + rounding ? Agreement::within : Agreement::differing;
}

void compare_row(const std::string& file, const CsvTable& first, const CsvTable& second, const Shared& columns,
                 ComparedRow row, bool is_rounded, TableComparison& to)
{
    const bool times = is_a_time(cell_or_nothing(first, row.first, "quantity"));
    for (const std::string& column : columns.results) {
        const std::string &one = first.text_at(row.first, column), &other = second.text_at(row.second, column);
        if (times || (one.empty() && other.empty())) continue;
        ++row.numbers;
        const double value = number_in(one).value_or(0.0);
        const Agreement found = agreement(one, other, tolerance_of(file, first, row.first, column, value), is_rounded);
        row.equal += found == Agreement::equal;
        if (found != Agreement::differing) continue;
        ++row.differing;
        to.differing.push_back({row.settings, column, one, other});
    }
    to.rows.push_back(row);
}

}  // namespace

TableComparison compare_tables(const std::string& file, const CsvTable& first, const CsvTable& second,
                               const ComparedAs& as)
{
    TableComparison compared{.columns_only_first = columns_without(first, second),
                             .columns_only_second = columns_without(second, first)};
    const Shared columns = shared_columns(file, first, second, as);
    const auto in_first = rows_by_settings(first, columns.settings),
               in_second = rows_by_settings(second, columns.settings);
    for (const auto& [settings, row] : in_first) {
        if (const auto same = in_second.find(settings); same != in_second.end())
            compare_row(file, first, second, columns,
                        {.settings = settings.first, .first = row, .second = same->second}, as.is_rounded, compared);
        else
            compared.only_first.push_back(settings.first);
    }
    for (const auto& [settings, row] : in_second)
        if (!in_first.contains(settings)) compared.only_second.push_back(settings.first);
    return compared;
}

}  // namespace analysis
