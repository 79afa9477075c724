#include "analysis/verdicts/measurement.hpp"

#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

const Columns<Measurement>& measurement_columns()
{
    static const Columns<Measurement> columns =
        MEMBER_COLUMNS(Measurement, claim, quantity) + within(&Measurement::of, case_key_columns()) +
        MEMBER_COLUMNS(Measurement, value, low, high, unit) +
        optional(Columns<Measurement>{column_with_empty(Limit::none, "limit", &Measurement::limit),
                                      column_with_empty(0, "n", &Measurement::n),
                                      column_with_empty(0, "not_reached", &Measurement::not_reached)});
    return columns;
}

CaseKey key_of(const CaseRecord& record)
{
    CaseKey key = record.place;
    if (key.body.empty()) key.body = record.scene;
    key.deformer = record.deformer;
    key.variant = record.variant;
    key.order = record.order;
    key.precision = record.precision;
    if (record.iterations > 0) key.iterations = record.iterations;
    return key;
}

// The values of all frames, or of one frame of a sweep.
void add_values(const CaseRecord& record, const CaseKey& key, const std::vector<double>& loss,
                const std::vector<double>& absolute, std::vector<Measurement>& to)
{
    const std::string mean_of = record.is_sweep() ? "" : "mean_";
    const auto add = [&](const std::string& quantity, const std::vector<double>& values, const char* unit) {
        const auto [least, most] = std::ranges::minmax(values);
        to.push_back({.quantity = quantity,
                      .of = key,
                      .value = mean(values),
                      .low = least,
                      .high = most,
                      .unit = unit,
                      .run = record.run,
                      .beside = record.beside});
    };
    add(mean_of + "volume_loss_pct", loss, "%");
    add(mean_of + "volume_abs_change_pct", absolute, "%");
    if (record.is_sweep()) return;  // its frames are no sample of a motion
    add("share_of_frames_within_half_pct", {share_of_kept_frames(loss)}, "1");
    to.back().n = static_cast<int>(loss.size());
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

std::map<CaseKey, std::map<double, Measurement>> series_over(const std::vector<Measurement>& measured,
                                                             const std::string& quantity,
                                                             std::optional<double> CaseKey::*field)
{
    std::map<CaseKey, std::map<double, Measurement>> all;
    for (const Measurement& measurement : measured) {
        if (measurement.quantity != quantity || !(measurement.of.*field)) continue;
        CaseKey of = measurement.of;
        (of.*field).reset();
        all[of].emplace(*(measurement.of.*field), measurement);
    }
    return all;
}

const Measurement* find_measurement(const std::vector<Measurement>& measured, const std::string& quantity,
                                    const CaseKey& of)
{
    const auto is_wanted = [&](const Measurement& measurement) {
        return measurement.quantity == quantity && measurement.of == of;
    };
    const auto found = std::ranges::find_if(measured, is_wanted);
    return found == measured.end() ? nullptr : &*found;
}

double share_of_kept_frames(const std::vector<double>& volume_change_pct)
{
    const auto is_kept = [](double change_pct) { return std::abs(change_pct) <= kept_volume_pct; };
    return static_cast<double>(std::ranges::count_if(volume_change_pct, is_kept)) /
           static_cast<double>(volume_change_pct.size());
}

std::vector<Measurement> frame_measurements(const CaseRecord& record)
{
    std::vector<Measurement> measured;
    require_whole(record);
    if (record.frame.empty()) return measured;
    std::vector<double> loss;
    for (const double change : record.volume_change_pct) loss.push_back(0.0 - change);  // and no -0
    CaseKey key = key_of(record);
    if (!record.is_sweep()) add_values(record, key, loss, record.volume_abs_change_pct, measured);
    for (std::size_t i = 0; record.is_sweep() && i < loss.size(); ++i) {
        key.angle_deg = record.angle_deg[i];
        add_values(record, key, {loss[i]}, {record.volume_abs_change_pct[i]}, measured);
    }
    return measured;
}

}  // namespace analysis
