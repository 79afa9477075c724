#include "experiments/studies/equal_quality/order_report.hpp"

#include "analysis/records/report_table.hpp"
#include "analysis/statistics/statistics.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Columns;
using analysis::within;

CaseKey of_plain(CaseKey key)
{
    key.order = "plain";
    return key;
}

bool is_random(const std::string& sequence)
{
    return sequence != file_sequence && sequence != spread_sequence;
}

// Rows of one order, or of one order and target. std::out_of_range without the sequence.
template <typename Row>
const Row& in_sequence(const std::vector<Row>& rows, const std::string& sequence)
{
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.sequence == sequence; });
    if (found == rows.end()) throw std::out_of_range("no rows in the sequence " + sequence);
    return *found;
}

template <typename Row, typename Value>
std::vector<double> in_random_sequences(const std::vector<Row>& rows, const Value& value)
{
    std::vector<double> values;
    for (const Row& row : rows)
        if (is_random(row.sequence)) values.push_back(value(row));
    return values;
}

std::vector<OrderRow> of_order(const std::vector<OrderRow>& rows, const CaseKey& of)
{
    std::vector<OrderRow> own;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(own), [&](const OrderRow& row) { return row.of == of; });
    return own;
}

std::vector<TargetRow> of_target(const std::vector<TargetRow>& rows, const CaseKey& of, const std::string& target)
{
    std::vector<TargetRow> own;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(own),
                 [&](const TargetRow& row) { return row.of == of && row.target == target; });
    return own;
}

// Nothing unless all of them reach the target.
std::optional<double> random_median_ms(const std::vector<TargetRow>& rows)
{
    std::vector<double> ms;
    for (const TargetRow& row : rows)
        if (is_random(row.sequence)) {
            if (!row.ms) return {};
            ms.push_back(*row.ms);
        }
    return ms.empty() ? std::nullopt : std::optional(analysis::median(ms));
}

std::optional<double> ratio(const std::optional<double>& ms, const std::optional<double>& own_ms)
{
    return ms && own_ms && *own_ms > 0.0 ? std::optional(*ms / *own_ms) : std::nullopt;
}

}  // namespace

const Columns<OrderSummary> summary_columns =
    within(&OrderSummary::of, order_key_columns()) +
    Columns<OrderSummary>{
        {"iteration_ms", &OrderSummary::iteration_ms, "ms", "one iteration of one pose in file order"},
        {"ratio_to_plain_spread", &OrderSummary::ratio_to_plain_spread, "", "iteration of plain in the spread sequence over this one's"},
        {"volume_abs_change_24_pct", &OrderSummary::volume_abs_change_24_pct, "%",
         "absolute volume change after 24 iterations, file order"},
        {"random_low_pct", &OrderSummary::random_low_pct, "%", "the least of the random sequences"},
        {"random_median_pct", &OrderSummary::random_median_pct, "%", "their median"},
        {"random_high_pct", &OrderSummary::random_high_pct, "%", "the largest"},
        {"volume_to_random_plain", &OrderSummary::volume_to_random_plain, "", "over the median of plain in random sequences"},
        {"residual_to_random_plain", &OrderSummary::residual_to_random_plain, "", "the same of the combined residual"},
        {"volume_abs_change_limit_pct", &OrderSummary::volume_abs_change_limit_pct, "%", "after the last iteration, file order"}};

const Columns<EqualAnswer> answer_columns =
    within(&EqualAnswer::of, order_key_columns()) +
    Columns<EqualAnswer>{
        {"target", &EqualAnswer::target, "", "as in targets.csv"},
        {"bound", &EqualAnswer::bound, "", "value of the target: a ratio, of a volume in %"},
        {"iterations", &EqualAnswer::iterations, "", "until the target is reached in file order"},
        {"ms", &EqualAnswer::ms, "ms", "time of these iterations"},
        {"limit", &EqualAnswer::limit, "", "the value after the last iteration in file order: a ratio, of a volume in %"},
        {"random_reached", &EqualAnswer::random_reached, "", "number of random sequences that reach the target"},
        {"random", &EqualAnswer::random, "", "number of random sequences"},
        {"random_median_ms", &EqualAnswer::random_median_ms, "ms", "median time in random sequences, if all reach the target"},
        {"speedup_to_plain", &EqualAnswer::speedup_to_plain, "", "time of plain in file order to the same target over this one's"},
        {"speedup_to_plain_spread", &EqualAnswer::speedup_to_plain_spread, "", "time of plain in the spread sequence over this one's"},
        {"random_speedup_to_plain", &EqualAnswer::random_speedup_to_plain, "", "ratio of the medians in random sequences"}};

std::vector<OrderSummary> summaries(const std::vector<OrderRow>& rows)
{
    std::vector<OrderSummary> all;
    for (const OrderRow& row : rows) {
        if (row.sequence != file_sequence) continue;
        const std::vector<OrderRow> own = of_order(rows, row.of), plain = of_order(rows, of_plain(row.of));
        const auto volume = [](const OrderRow& one) { return one.volume_abs_change_24_pct; };
        const auto residual = [](const OrderRow& one) { return one.residual_24; };
        const std::vector<double> random = in_random_sequences(own, volume);
        all.push_back({row.of, row.ms_iteration.median, in_sequence(plain, spread_sequence).ms_iteration.median / row.ms_iteration.median,
                       row.volume_abs_change_24_pct, analysis::quantile(random, 0.0), analysis::median(random),
                       analysis::quantile(random, 1.0), row.volume_abs_change_24_pct / analysis::median(in_random_sequences(plain, volume)),
                       row.residual_24 / analysis::median(in_random_sequences(plain, residual)), row.volume_abs_change_limit_pct});
    }
    return all;
}

std::vector<EqualAnswer> equal_answers(const std::vector<TargetRow>& rows)
{
    std::vector<EqualAnswer> all;
    for (const TargetRow& row : rows) {
        if (row.sequence != file_sequence) continue;
        const std::vector<TargetRow> own = of_target(rows, row.of, row.target), plain = of_target(rows, of_plain(row.of), row.target);
        const std::vector<double> reached = in_random_sequences(own, [](const TargetRow& one) { return double(one.reached); });
        EqualAnswer answer{row.of, row.target, row.bound, row.iterations, row.ms, row.limit};
        answer.random = static_cast<int>(reached.size());
        answer.random_reached = static_cast<int>(std::count(reached.begin(), reached.end(), 1.0));
        answer.random_median_ms = random_median_ms(own);
        answer.speedup_to_plain = ratio(in_sequence(plain, file_sequence).ms, row.ms);
        answer.speedup_to_plain_spread = ratio(in_sequence(plain, spread_sequence).ms, row.ms);
        answer.random_speedup_to_plain = ratio(random_median_ms(plain), answer.random_median_ms);
        all.push_back(answer);
    }
    return all;
}

std::string order_report(const std::vector<OrderSummary>& orders, const std::vector<EqualAnswer>& answers)
{
    const std::string none = "\u2013";
    const std::vector<analysis::ReportColumn> of = {
        {"body", "body"}, {"angle", "angle_deg", "{:.0f}", 1.0, none}, {"pose", "pose"}, {"order", "order"}, {"precision", "precision"}};
    const auto with = [&](std::vector<analysis::ReportColumn> more) {
        more.insert(more.begin(), of.begin(), of.end());
        return more;
    };
    return "The first table has the volume change after 24 iterations and in the limit. A ratio above 1 to the random sequences of plain "
           "is "
           "a loss. Every time of plain is that of the order `plain`, which is built for the same bits on every machine.\n\n" +
           markdown_table(table_of(summary_columns, orders), with({{"ms per iteration", "iteration_ms", "{:.4f}"},
                                                                   {"times faster than plain, spread", "ratio_to_plain_spread", "{:.1f}"},
                                                                   {"volume change [%]", "volume_abs_change_24_pct", "{:.3f}"},
                                                                   {"random: least", "random_low_pct", "{:.3f}"},
                                                                   {"median", "random_median_pct", "{:.3f}"},
                                                                   {"largest", "random_high_pct", "{:.3f}"},
                                                                   {"to random plain", "volume_to_random_plain", "{:.3f}"},
                                                                   {"residual to random plain", "residual_to_random_plain", "{:.3f}"},
                                                                   {"limit [%]", "volume_abs_change_limit_pct", "{:.3f}"}})) +
           "\nThe second table has the time to an equal answer. A dash states that the target is never reached, so that no speed-up "
           "exists.\n\n" +
           markdown_table(table_of(answer_columns, answers),
                          with({{"target", "target"},
                                {"bound", "bound", "{:.4g}"},
                                {"iterations", "iterations", "{:.0f}", 1.0, none},
                                {"ms", "ms", "{:.2f}", 1.0, none},
                                {"limit", "limit", "{:.4g}"},
                                {"random: reached", "random_reached", "{:.0f}"},
                                {"ms", "random_median_ms", "{:.2f}", 1.0, none},
                                {"times faster than plain", "speedup_to_plain", "{:.2f}", 1.0, none},
                                {"than plain, spread", "speedup_to_plain_spread", "{:.2f}", 1.0, none},
                                {"random: than plain", "random_speedup_to_plain", "{:.2f}", 1.0, none}}));
}

}  // namespace experiments
