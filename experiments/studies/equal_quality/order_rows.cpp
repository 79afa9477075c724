#include "experiments/studies/equal_quality/order_rows.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Columns;
using analysis::within;

CaseKey key_of(CaseKey of, const MeasuredOrder& measured)
{
    of.order = measured.order;
    of.precision = measured.precision;
    return of;
}

const IterationPath& plain_in_file_order(const std::vector<MeasuredOrder>& measured, const std::string& precision)
{
    const auto found = std::find_if(measured.begin(), measured.end(), [&](const MeasuredOrder& one) {
        return one.order == "plain" && one.sequence == file_sequence && one.precision == precision;
    });
    if (found == measured.end()) throw std::logic_error("no plain in file order and " + precision);
    return found->path;
}

struct Target {
    const char* name;
    double Look::*value;
    double bound;
};

std::vector<Target> targets(const IterationPath& plain)
{
    const Look& after_24 = look_at(plain, paper_iterations);
    return {{"residual_of_plain", &Look::combined, after_24.combined},
            {"volume_of_plain", &Look::volume_abs_change_pct, after_24.volume_abs_change_pct},
            {"volume_2_pct", &Look::volume_abs_change_pct, 2.0},
            {"volume_05_pct", &Look::volume_abs_change_pct, volume_tolerance_pct}};
}

}  // namespace

const Columns<CaseKey>& order_key_columns()
{
    static const Columns<CaseKey> columns = {{"body", &CaseKey::body, "", "name of the body"},
                                             {"motion", &CaseKey::motion, "", "twist, or the name of a clip"},
                                             {"pose", &CaseKey::pose, "", "name of a pose in a clip"},
                                             {"angle_deg", &CaseKey::angle_deg, "deg", "angle of the joint that is twisted"},
                                             {"order", &CaseKey::order, "", "plain, ordered, grouped or poses"},
                                             {"precision", &CaseKey::precision, "", "f32 or f64"}};
    return columns;
}

const Columns<OrderRow> order_columns =
    within(&OrderRow::of, order_key_columns()) +
    Columns<OrderRow>{{"sequence", &OrderRow::sequence, "", "of the constraints: file, spread, random_SEED"}} +
    within(&OrderRow::ms_iteration, spread_columns("iteration_ms", "ms", "one iteration of one pose, processor time of one thread")) +
    Columns<OrderRow>{
        {"residual_24", &OrderRow::residual_24, "", "combined residual after 24 iterations"},
        {"volume_abs_change_24_pct", &OrderRow::volume_abs_change_24_pct, "%", "absolute volume change after 24 iterations"},
        {"residual_limit", &OrderRow::residual_limit, "", "combined residual after the last iteration"},
        {"volume_abs_change_limit_pct", &OrderRow::volume_abs_change_limit_pct, "%", "absolute volume change after the last iteration"},
        {"residual_half", &OrderRow::residual_half, "", "combined residual after half of the iterations"},
        {"volume_abs_change_half_pct", &OrderRow::volume_abs_change_half_pct, "%", "absolute volume change after half of the iterations"},
        {"iterations", &OrderRow::iterations, "", "number of the last iteration"}};

const Columns<TargetRow> target_columns =
    within(&TargetRow::of, order_key_columns()) +
    Columns<TargetRow>{{"sequence", &TargetRow::sequence, "", "of the constraints: file, spread, random_SEED"},
                       {"target", &TargetRow::target, "",
                        "residual_of_plain or volume_of_plain after 24 iterations in file order; volume_2_pct, volume_05_pct"},
                       {"bound", &TargetRow::bound, "", "value of the target: a ratio, of a volume in %"},
                       {"reached", &TargetRow::reached, "", "whether the value was ever at or below the bound"},
                       {"iterations", &TargetRow::iterations, "", "until then"},
                       {"ms", &TargetRow::ms, "ms", "time of these iterations, one thread, per pose"},
                       {"limit", &TargetRow::limit, "", "the value after the last iteration: a ratio, of a volume in %"}};

std::optional<int> first_within(const IterationPath& path, double Look::*value, double bound)
{
    const auto found = std::find_if(path.looks.begin(), path.looks.end(), [&](const Look& look) { return look.*value <= bound; });
    return found == path.looks.end() ? std::nullopt : std::optional(found->iteration);
}

std::vector<OrderRow> order_rows(const CaseKey& of, const std::vector<MeasuredOrder>& measured)
{
    std::vector<OrderRow> rows;
    for (const MeasuredOrder& one : measured) {
        const Look &last = one.path.looks.back(), &half = look_at(one.path, last.iteration / 2),
                   &after_24 = look_at(one.path, paper_iterations);
        rows.push_back({key_of(of, one), one.sequence, one.ms_iteration, after_24.combined, after_24.volume_abs_change_pct, last.combined,
                        last.volume_abs_change_pct, half.combined, half.volume_abs_change_pct, last.iteration});
    }
    return rows;
}

std::vector<TargetRow> target_rows(const CaseKey& of, const std::vector<MeasuredOrder>& measured)
{
    std::vector<TargetRow> rows;
    for (const MeasuredOrder& one : measured)
        for (const Target& target : targets(plain_in_file_order(measured, one.precision))) {
            TargetRow row{key_of(of, one), one.sequence, target.name, target.bound};
            row.iterations = first_within(one.path, target.value, target.bound);
            row.reached = row.iterations.has_value();
            if (row.iterations) row.ms = *row.iterations * one.ms_iteration.median;
            row.limit = one.path.looks.back().*target.value;
            rows.push_back(row);
        }
    return rows;
}

}  // namespace experiments
