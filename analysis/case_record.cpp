#include "analysis/case_record.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

namespace analysis {
namespace {

std::string key_of(const CsvTable& metrics, int row)
{
    std::string key;
    for (const char* column : {"scene", "deformer", "variant", "order", "precision", "iterations", "threads"})
        key += metrics.text_at(row, column) + '\n';
    return key;
}

CaseRecord empty_record(const CsvTable& metrics, int row, const std::string& run)
{
    CaseRecord record;
    record.scene = metrics.text_at(row, "scene");
    record.deformer = metrics.text_at(row, "deformer");
    record.variant = metrics.text_at(row, "variant");
    record.order = metrics.text_at(row, "order");
    record.precision = metrics.text_at(row, "precision");
    if (!metrics.text_at(row, "iterations").empty()) record.iterations = static_cast<int>(metrics.integer(row, "iterations"));
    record.run = run;
    return record;
}

void add_frame(CaseRecord& record, const CsvTable& metrics, int row)
{
    record.frame.push_back(metrics.number(row, "frame"));
    record.time_s.push_back(metrics.number(row, "time_s"));
    record.volume_change_pct.push_back(metrics.number(row, "volume_change_pct"));
    record.volume_abs_change_pct.push_back(metrics.number(row, "volume_abs_change_pct"));
    record.inverted_tets.push_back(metrics.number(row, "inverted_tets"));
    if (!metrics.has_column("angle_deg")) return;
    if (const auto angle = metrics.number_or_nothing(row, "angle_deg")) record.angle_deg.push_back(*angle);
}

bool is_not_reached(const CaseRecord& record, const CsvTable& metrics, int row)
{
    return record.iterations == 0 && metrics.has_column("outcome") && metrics.text_at(row, "outcome") == "not_converged";
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

}  // namespace

std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run)
{
    std::vector<CaseRecord> records;
    std::map<std::string, std::size_t> places;
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto [place, is_new] = places.try_emplace(key_of(metrics, row), records.size());
        if (is_new) records.push_back(empty_record(metrics, row, run));
        CaseRecord& record = records[place->second];
        if (is_not_reached(record, metrics, row))
            ++record.frames_not_converged;
        else
            add_frame(record, metrics, row);
    }
    for (const CaseRecord& record : records) require_whole(record);
    return records;
}

std::vector<PrintedValue> printed_values(const std::string& csv)
{
    const CsvTable table = read_csv(csv);
    std::vector<PrintedValue> values;
    for (int row = 0; row < table.rows(); ++row)
        values.push_back({table.text_at(row, "claim"), table.text_at(row, "quantity"), case_key(table, row), table.number(row, "printed"),
                          table.number(row, "least"),
                          table.number_or_nothing(row, "most").value_or(std::numeric_limits<double>::infinity())});
    return values;
}

CsvTable printed_table(const std::vector<PrintedValue>& values)
{
    std::vector<const CaseKey*> keys;
    for (const PrintedValue& value : values) keys.push_back(&value.of);
    const auto fields = used_fields(keys);
    std::vector<std::string> columns = {"claim", "quantity"};
    for (const CaseKeyField* field : fields) columns.emplace_back(field->name);
    columns.insert(columns.end(), {"printed", "least", "most"});
    CsvTable table(columns);
    for (const PrintedValue& value : values) {
        std::vector<CsvTable::Cell> cells = {value.claim, value.quantity};
        for (const CaseKeyField* field : fields) cells.push_back(cell_of(*field, value.of));
        cells.insert(cells.end(), {CsvTable::Cell(value.printed), CsvTable::Cell(value.least),
                                   std::isinf(value.most) ? CsvTable::Cell(std::nullopt) : CsvTable::Cell(value.most)});
        table.add_row(cells);
    }
    return table;
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
