#include "analysis/case_record.hpp"

#include "analysis/records/optional_columns.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace analysis {
namespace {

// The columns of metrics.csv that identify the case and the frame of a row, and those that are judged. The file has further columns.
struct MetricsRow {
    std::string scene, deformer, variant, order, precision;
    std::optional<int> iterations;
    std::string threads, outcome;
    double frame = 0.0, time_s = 0.0, volume_change_pct = 0.0, volume_abs_change_pct = 0.0, inverted_tets = 0.0;
    std::optional<double> angle_deg;
};

const Columns<MetricsRow>& metrics_columns()
{
    static const Columns<MetricsRow> columns =
        Columns<MetricsRow>{{"scene", &MetricsRow::scene, "", "name of the scene"},
                            {"deformer", &MetricsRow::deformer, "", "name of the deformer"},
                            {"variant", &MetricsRow::variant, "", "its variant"},
                            {"order", &MetricsRow::order, "", "order of projection"},
                            {"precision", &MetricsRow::precision, "", "f32 or f64"},
                            {"iterations", &MetricsRow::iterations, "", "iterations per step"},
                            {"threads", &MetricsRow::threads, "", "number of threads"},
                            {"frame", &MetricsRow::frame, "", "number of the frame, from 0"},
                            {"time_s", &MetricsRow::time_s, "s", "time in the motion"},
                            {"volume_change_pct", &MetricsRow::volume_change_pct, "%", "signed change of the whole volume"},
                            {"volume_abs_change_pct", &MetricsRow::volume_abs_change_pct, "%", "sum of the absolute changes of each tet"},
                            {"inverted_tets", &MetricsRow::inverted_tets, "", "number of inverted tets"}} +
        optional(Columns<MetricsRow>{{"angle_deg", &MetricsRow::angle_deg, "deg", "angle of the joint, in a sweep"},
                                     {"outcome", &MetricsRow::outcome, "", "of the frame"}});
    return columns;
}

auto case_of(const MetricsRow& row)
{
    return std::tie(row.scene, row.deformer, row.variant, row.order, row.precision, row.iterations, row.threads);
}

CaseRecord empty_record(const MetricsRow& row, const std::string& run)
{
    CaseRecord record;
    record.scene = row.scene;
    record.deformer = row.deformer;
    record.variant = row.variant;
    record.order = row.order;
    record.precision = row.precision;
    record.iterations = row.iterations.value_or(0);
    record.run = run;
    return record;
}

void add_frame(CaseRecord& record, const MetricsRow& row)
{
    record.frame.push_back(row.frame);
    record.time_s.push_back(row.time_s);
    record.volume_change_pct.push_back(row.volume_change_pct);
    record.volume_abs_change_pct.push_back(row.volume_abs_change_pct);
    record.inverted_tets.push_back(row.inverted_tets);
    if (row.angle_deg) record.angle_deg.push_back(*row.angle_deg);
}

void require_whole(const CaseRecord& record)
{
    const std::size_t frames = record.frame.size();
    const bool angles_fit = record.angle_deg.empty() || record.angle_deg.size() == frames;
    if (record.time_s.size() != frames || record.volume_change_pct.size() != frames || record.volume_abs_change_pct.size() != frames ||
        record.inverted_tets.size() != frames || !angles_fit)
        throw pbs::InputError(record.run, 0, fmt::format("record of {} on {}", record.deformer, record.scene), "",
                              fmt::format("expected {} values in every series", frames));
}

const Columns<PrintedValue>& printed_columns()
{
    static const Columns<PrintedValue> columns =
        Columns<PrintedValue>{{"claim", &PrintedValue::claim, "", "id of the claim"},
                              {"quantity", &PrintedValue::quantity, "", "what is printed"}} +
        within(&PrintedValue::of, case_key_columns()) +
        Columns<PrintedValue>{{"printed", &PrintedValue::printed, "", "the printed value"},
                              {"least", &PrintedValue::least, "", "its lower bound"},
                              column_with_empty(std::numeric_limits<double>::infinity(), "most", &PrintedValue::most, "",
                                                "its upper bound; empty if there is none")};
    return columns;
}

}  // namespace

std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run)
{
    const std::vector<MetricsRow> rows = rows_of(metrics_columns(), metrics);
    std::vector<CaseRecord> records;
    std::map<decltype(case_of(rows.front())), std::size_t> places;
    for (const MetricsRow& row : rows) {
        const auto [place, is_new] = places.try_emplace(case_of(row), records.size());
        if (is_new) records.push_back(empty_record(row, run));
        CaseRecord& record = records[place->second];
        if (record.iterations == 0 && row.outcome == "not_converged")
            ++record.frames_not_converged;
        else
            add_frame(record, row);
    }
    for (const CaseRecord& record : records) require_whole(record);
    return records;
}

std::vector<PrintedValue> printed_values(const std::string& csv)
{
    return rows_of(printed_columns(), read_csv(csv));
}

CsvTable printed_table(const std::vector<PrintedValue>& values)
{
    return table_of(used_columns(printed_columns(), values), values);
}

std::vector<double> metric_series(const CaseRecord& record, const std::string& metric)
{
    require_whole(record);
    if (metric == "volume_change_pct") return record.volume_change_pct;
    if (metric == "volume_abs_change_pct") return record.volume_abs_change_pct;
    if (metric != "volume_loss_pct") throw pbs::InputError("", 0, "metric", metric, "no verdict is computed from it");
    std::vector<double> loss;
    for (double change : record.volume_change_pct) loss.push_back(0.0 - change);  // and no -0
    return loss;
}

}  // namespace analysis
