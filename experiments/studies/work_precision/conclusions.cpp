#include "experiments/studies/work_precision/conclusions.hpp"

#include "analysis/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace experiments {

using analysis::Columns;
using analysis::not_known;

const Columns<OwnErrorRow> own_error_columns =
    MEMBER_COLUMNS(OwnErrorRow, pose, body, stratum, member, outcome, own_error_pct);
const Columns<ComparedRow> compared_columns =
    MEMBER_COLUMNS(ComparedRow, table, budget_ms) +
    analysis::within(&ComparedRow::point, MEMBER_COLUMNS(PointRow, method, pose, body, stratum, ms, skin_mm) +
                                              analysis::within(&PointRow::errors, member_error_columns()));
const Columns<MethodRow> method_columns =
    MEMBER_COLUMNS(MethodRow, table, budget_ms, method, takes, setting, ms, times_pbs, within, poses, fewest_poses,
                   share, share_low, share_high, fold_share, fold_low, fold_high, skin_mm, inverted_poses, letters);
const Columns<MethodPairRow> method_pair_columns =
    MEMBER_COLUMNS(MethodPairRow, table, budget_ms, first, second, member, wins, ties, losses, p, p_holm, ratio,
                   ratio_low, ratio_high);
const Columns<DecisionRow> decision_columns =
    MEMBER_COLUMNS(DecisionRow, table, budget_ms, without_body, first, second, decision);
const Columns<MethodCurveRow> method_curve_columns =
    MEMBER_COLUMNS(MethodCurveRow, table, method, budget_ms, setting, ms, share, share_low, share_high);
const Columns<SolvedRow> solved_columns = MEMBER_COLUMNS(SolvedRow, table, target_pct, method, budget_ms, solved_pct);
const Columns<OtherStartRow> other_start_columns =
    MEMBER_COLUMNS(OtherStartRow, budget_ms, method, of, poses, share, share_of_setting);
const Columns<MotionRow> motion_columns = MEMBER_COLUMNS(MotionRow, clip, budget_ms, method, setting, member, frames,
                                                         ms, cold_share, played_share, cold_skin_mm, played_skin_mm);

namespace {

constexpr const char* baseline = "lbs";
constexpr double any_time_ms = std::numeric_limits<double>::infinity();
constexpr double targets_pct[] = {20.0, 35.0, 50.0};  // of LBS's error

struct Spread {
    double middle = not_known, low = not_known, high = not_known;
};
Spread spread_over(std::vector<double> members)
{
    std::erase_if(members, [](double value) { return std::isnan(value); });
    if (members.empty()) return {};
    const auto [low, high] = std::ranges::minmax(members);
    return {analysis::median(members), low, high};
}

// The rows of one setting of each method in all poses of the strata that are compared.
class PosesOfTable {
public:
    PosesOfTable(const std::vector<PointRow>& points, const std::vector<OwnErrorRow>& own) : points_(points)
    {
        for (const EnsembleMember& member : family()) compared_.members.push_back(member.name);
        for (const PointRow& point : points)
            if (point.stratum == Stratum::movement || point.stratum == Stratum::fold)
                if (place_.try_emplace(point.pose, place_.size()).second) {
                    compared_.bodies.push_back(point.body);
                    is_movement_.push_back(point.stratum == Stratum::movement);
                    is_fold_.push_back(point.stratum == Stratum::fold);
                }
        compared_.own_error.assign(compared_.members.size(), std::vector<double>(place_.size(), not_known));
        for (const OwnErrorRow& row : own) {
            const auto member = std::ranges::find(compared_.members, row.member) - compared_.members.begin();
            if (place_.contains(row.pose) && member < std::ssize(compared_.members) && row.own_error_pct)
                compared_.own_error[member][place_.at(row.pose)] = *row.own_error_pct;
        }
    }

    // The rows of the method in a table, by pose; empty: there is none.
    std::vector<const PointRow*> rows(const std::string& method, const std::string& setting,
                                      ComparisonTable table) const
    {
        const GivenFlesh flesh = table == ComparisonTable::known ? GivenFlesh::own : GivenFlesh::standard;
        std::vector<const PointRow*> rows(place_.size(), nullptr);
        bool any = false;
        for (const PointRow& point : points_) {
            if (point.method != method || point.setting != setting || !place_.contains(point.pose)) continue;
            if (point.flesh != GivenFlesh::none && point.flesh != flesh) continue;
            rows[place_.at(point.pose)] = &point;
            any = true;
        }
        return any ? rows : std::vector<const PointRow*>{};
    }

    analysis::MethodErrors errors(const std::string& method, const std::vector<const PointRow*>& rows) const
    {
        analysis::MethodErrors errors{method, {}};
        errors.error.assign(compared_.members.size(), std::vector<double>(place_.size(), not_known));
        for (std::size_t pose = 0; pose < rows.size(); ++pose)
            for (std::size_t m = 0; rows[pose] && m < compared_.members.size(); ++m)
                errors.error[m][pose] = rows[pose]->errors[m].value_or(not_known);
        return errors;
    }

    const analysis::ComparedPoses& compared() const { return compared_; }
    const std::vector<bool>& is_movement() const { return is_movement_; }
    const std::vector<bool>& is_fold() const { return is_fold_; }

private:
    const std::vector<PointRow>& points_;
    std::map<std::string, std::size_t> place_;  // of each pose
    analysis::ComparedPoses compared_;          // without methods
    std::vector<bool> is_movement_, is_fold_;   // #poses
};

Spread share_of(const analysis::MethodErrors& method, const analysis::MethodErrors& lbs, const std::vector<bool>& kept)
{
    std::vector<double> shares;
    for (std::size_t m = 0; m < method.error.size(); ++m)
        shares.push_back(analysis::share(method.error[m], lbs.error[m], kept));
    return spread_over(shares);
}

// The number of poses in which both methods have an error against each member.
std::vector<int> compared_poses(const analysis::MethodErrors& first, const analysis::MethodErrors& second,
                                const std::vector<bool>& kept)
{
    std::vector<int> poses;
    for (std::size_t m = 0; m < first.error.size(); ++m) {
        poses.push_back(0);
        for (std::size_t pose = 0; pose < kept.size(); ++pose)
            poses.back() += kept[pose] && !std::isnan(first.error[m][pose]) && !std::isnan(second.error[m][pose]);
    }
    return poses;
}

// Over the poses by movement.
template <typename Value>
std::optional<double> median_of(const std::vector<const PointRow*>& rows, const Value& value)
{
    std::vector<double> values;
    for (const PointRow* row : rows)
        if (row && row->stratum == Stratum::movement && value(*row)) values.push_back(*value(*row));
    return values.empty() ? std::nullopt : std::optional(analysis::median(values));
}

// One method in one table at one time.
struct Entry {
    const ComparedMethod* method;
    std::string setting;
    std::vector<const PointRow*> rows;
    analysis::MethodErrors errors;
};

std::vector<std::string> external_names(const std::vector<PointRow>& points)
{
    std::vector<std::string> names;
    for (const PointRow& point : points)
        if (point.setting.empty() && point.flesh == GivenFlesh::none &&
            std::ranges::count(methods(), point.method, &ComparedMethod::name) == 0 &&
            std::ranges::count(names, point.method) == 0)
            names.push_back(point.method);
    return names;
}

std::vector<Entry> entries_of(const PosesOfTable& poses, const std::vector<PointRow>& points,
                              const std::vector<ChosenSetting>& settings, ComparisonTable table, double budget_ms)
{
    std::vector<Entry> entries;
    const auto add = [&](const ComparedMethod* method, const std::string& name, const std::string& setting) {
        std::vector<const PointRow*> rows = poses.rows(name, setting, table);
        if (rows.empty()) return;
        analysis::MethodErrors errors = poses.errors(name, rows);
        entries.push_back({method, setting, std::move(rows), std::move(errors)});
    };
    const double chosen_for_ms = std::min(budget_ms, comparison_times().budgets_ms.back());
    for (const ComparedMethod& method : methods()) {
        if (!method.is_in(name_of(table))) continue;
        for (const ChosenSetting& chosen : settings)
            if (chosen.method == method.name && chosen.budget_ms == chosen_for_ms)
                add(&method, method.name, chosen.setting);
    }
    for (const std::string& name : external_names(points)) {
        const auto ms = median_of(poses.rows(name, "", table), [](const PointRow& row) { return row.ms; });
        if (ms && *ms <= budget_ms) add(nullptr, name, "");
    }
    return entries;
}

// The times of a table. If a deformer of the user's own needs more than the longest of them, any time follows.
std::vector<double> times_of(const PosesOfTable& poses, const std::vector<PointRow>& points, ComparisonTable table)
{
    std::vector<double> times_ms = comparison_times().budgets_ms;
    const double longest_ms = times_ms.back();
    const bool is_slow = std::ranges::any_of(external_names(points), [&](const std::string& name) {
        return median_of(poses.rows(name, "", table), [](const PointRow& row) { return row.ms; }).value_or(0.0) >
               longest_ms;
    });
    if (is_slow) times_ms.push_back(any_time_ms);
    return times_ms;
}

MethodRow method_row(const Entry& entry, const Entry& lbs, const PosesOfTable& poses, ComparisonTable table,
                     double budget_ms)
{
    MethodRow row{.table = table, .budget_ms = budget_ms, .method = entry.errors.method};
    if (entry.method) row.takes = entry.method->takes;
    row.setting = entry.setting;
    row.ms = median_of(entry.rows, [](const PointRow& point) { return point.ms; });
    row.times_pbs = median_of(entry.rows, [](const PointRow& point) { return point.times_pbs; });
    const double ms = row.ms.value_or(0.0);
    row.within = 2.0 * ms <= budget_ms ? "doubled" : ms <= budget_ms ? "once" : "no";
    const std::vector<int> compared = compared_poses(entry.errors, lbs.errors, poses.is_movement());
    row.poses = std::ranges::max(compared);
    row.fewest_poses = std::ranges::min(compared);
    const Spread share = share_of(entry.errors, lbs.errors, poses.is_movement());
    row.share = share.middle;
    row.share_low = share.low;
    row.share_high = share.high;
    if (const Spread fold = share_of(entry.errors, lbs.errors, poses.is_fold()); !std::isnan(fold.middle)) {
        row.fold_share = fold.middle;
        row.fold_low = fold.low;
        row.fold_high = fold.high;
    }
    row.skin_mm = median_of(entry.rows, [](const PointRow& point) { return point.skin_mm; });
    for (const PointRow* point : entry.rows)
        row.inverted_poses += point && point->stratum == Stratum::movement && point->inverted > 0;
    return row;
}

// The pairs of a table at one time, and what each body changes.
void add_pairs(const std::vector<Entry>& entries, const PosesOfTable& poses, std::vector<MethodRow>& rows,
               Comparison& comparison)
{
    analysis::ComparedPoses with_methods = poses.compared();
    for (const Entry& entry : entries) with_methods.methods.push_back(entry.errors);
    const analysis::ComparedPoses movement = analysis::selected_poses(with_methods, poses.is_movement());
    const std::vector<analysis::MethodPair> pairs = analysis::compare_methods(movement);
    const ComparisonTable table = rows.front().table;
    const double budget_ms = rows.front().budget_ms;
    const auto add_decisions = [&](const std::vector<analysis::MethodPair>& method_pairs,
                                   const std::string& without_body) {
        for (const analysis::MethodPair& pair : method_pairs)
            comparison.decisions.push_back({table, budget_ms, without_body, pair.first, pair.second, pair.decision});
    };
    for (const analysis::MethodPair& pair : pairs)
        for (std::size_t m = 0; m < pair.members.size(); ++m) {
            const analysis::MemberComparison& on = pair.members[m];
            if (on.poses() == 0) continue;
            comparison.pairs.push_back({table, budget_ms, pair.first, pair.second, movement.members[m], on.wins,
                                        on.ties, on.losses, on.p, on.p_holm, on.ratio.estimate, on.ratio.low,
                                        on.ratio.high});
        }
    add_decisions(pairs, "");
    for (const std::string& body : std::set<std::string>(movement.bodies.begin(), movement.bodies.end()))
        add_decisions(analysis::compare_methods(analysis::without_body(movement, body)), body);

    std::ranges::stable_sort(rows, {}, &MethodRow::share);
    std::vector<std::string> ranked;
    for (const MethodRow& row : rows) ranked.push_back(row.method);
    const std::vector<std::string> letters = analysis::letters(ranked, pairs);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].letters = letters[i];
}

// The share of movement poses whose error is at most this share of LBS's, in the mean over the members.
double solved_pct(const Entry& entry, const Entry& lbs, const PosesOfTable& poses, double target_pct)
{
    std::vector<double> of_member;
    for (std::size_t m = 0; m < entry.errors.error.size(); ++m) {
        int solved = 0, all = 0;
        for (std::size_t pose = 0; pose < poses.is_movement().size(); ++pose) {
            const double error = entry.errors.error[m][pose], of_lbs = lbs.errors.error[m][pose];
            if (!poses.is_movement()[pose] || std::isnan(of_lbs)) continue;
            ++all;
            solved += error <= target_pct / 100.0 * of_lbs;
        }
        if (all > 0) of_member.push_back(100.0 * solved / all);
    }
    return analysis::mean(of_member);
}

std::vector<OtherStartRow> start_rows(const std::vector<PointRow>& points, const std::vector<ChosenSetting>& settings)
{
    std::vector<OtherStartRow> rows;
    const auto errors_of = [&](const std::string& method, const std::string& setting, GivenFlesh flesh) {
        std::map<std::string, double> errors;  // by pose, against the first member
        for (const PointRow& point : points)
            if (point.method == method && point.setting == setting && point.errors[0] &&
                (point.flesh == flesh || point.flesh == GivenFlesh::none))
                errors[point.pose] = *point.errors[0];
        return errors;
    };
    const auto share = [](const std::map<std::string, double>& of, const std::map<std::string, double>& to,
                          const std::map<std::string, double>& in) {
        std::vector<double> own, other;
        for (const auto& [pose, error] : in)
            if (of.contains(pose) && to.contains(pose)) own.push_back(of.at(pose)), other.push_back(to.at(pose));
        return analysis::share(own, other);
    };
    for (const double budget_ms : comparison_times().tables_ms) {
        const auto setting_of = [&](const std::string& method) -> std::optional<std::string> {
            const auto chosen = std::ranges::find_if(settings, [&](const ChosenSetting& chosen_setting) {
                return chosen_setting.method == method && chosen_setting.budget_ms == budget_ms;
            });
            return chosen == settings.end() ? std::nullopt : std::optional(chosen->setting);
        };
        const std::optional<std::string> of_lbs = setting_of(baseline);
        if (!of_lbs) continue;
        const auto lbs = errors_of(baseline, *of_lbs, GivenFlesh::none);
        for (const OtherStart& start : other_starts()) {
            const std::optional<std::string> setting = setting_of(start.of);
            if (!setting) continue;
            const auto changed = errors_of(start.name, *setting, GivenFlesh::start);
            if (changed.empty()) continue;
            rows.push_back({budget_ms, start.name, start.of, static_cast<int>(changed.size()),
                            share(changed, lbs, changed),
                            share(errors_of(start.of, *setting, GivenFlesh::own), lbs, changed)});
        }
    }
    return rows;
}

}  // namespace

std::vector<ChosenSetting> chosen_settings(const std::vector<PointRow>& training)
{
    struct Tried {
        std::string method, setting;
        std::vector<double> ms, log_error;
        int poses = 0;
    };
    std::vector<Tried> tried;
    for (const PointRow& point : training) {
        auto found = std::ranges::find_if(
            tried, [&](const Tried& entry) { return entry.method == point.method && entry.setting == point.setting; });
        if (found == tried.end())
            found =
                tried.insert(found, Tried{.method = point.method, .setting = point.setting, .ms = {}, .log_error = {}});
        found->poses += point.outcome == "finished";
        if (point.ms) found->ms.push_back(*point.ms);
        for (const std::optional<double>& error : point.errors)
            if (error) found->log_error.push_back(std::log(*error));
    }
    int poses = 0;  // a ladder that ended early on entry body, or a shape that is not finite, has fewer
    for (const Tried& entry : tried) poses = std::max(poses, entry.poses);
    std::vector<ChosenSetting> chosen;
    for (const ComparedMethod& method : methods())
        for (const double budget_ms : comparison_times().budgets_ms) {
            const Tried* best = nullptr;
            for (const Tried& entry : tried) {
                if (entry.method != method.name || entry.poses < poses || entry.log_error.empty() ||
                    analysis::mean(entry.ms) > budget_ms)
                    continue;
                if (!best || analysis::mean(entry.log_error) < analysis::mean(best->log_error)) best = &entry;
            }
            if (best)
                chosen.push_back({budget_ms, method.name, best->setting, analysis::mean(best->ms),
                                  std::exp(analysis::mean(best->log_error))});
        }
    return chosen;
}

Comparison concluded(const std::vector<PointRow>& points, const std::vector<OwnErrorRow>& own,
                     const std::vector<ChosenSetting>& settings)
{
    Comparison comparison;
    const PosesOfTable poses(points, own);
    for (const ComparisonTable table : {ComparisonTable::known, ComparisonTable::guessed})
        for (const double budget_ms : times_of(poses, points, table)) {
            const bool is_any_time = budget_ms == any_time_ms;
            const std::vector<Entry> entries = entries_of(poses, points, settings, table, budget_ms);
            const auto lbs =
                std::ranges::find(entries, baseline, [](const Entry& entry) { return entry.errors.method; });
            if (lbs == entries.end()) continue;
            std::vector<MethodRow> rows;
            for (const Entry& entry : entries) {
                rows.push_back(method_row(entry, *lbs, poses, table, budget_ms));
                const MethodRow& row = rows.back();
                comparison.curves.push_back({table, row.method, budget_ms, row.setting, row.ms.value_or(not_known),
                                             row.share, row.share_low, row.share_high});
                if (is_any_time) continue;  // a profile is a function of the time
                for (const double target_pct : targets_pct)
                    comparison.profiles.push_back(
                        {table, target_pct, row.method, budget_ms, solved_pct(entry, *lbs, poses, target_pct)});
            }
            if (!is_any_time && std::ranges::count(comparison_times().tables_ms, budget_ms) == 0) continue;
            for (const Entry& entry : entries)
                for (const PointRow* point : entry.rows)
                    if (point) comparison.errors.push_back({table, budget_ms, *point});
            add_pairs(entries, poses, rows, comparison);
            comparison.methods.insert(comparison.methods.end(), rows.begin(), rows.end());
        }
    comparison.starts = start_rows(points, settings);
    return comparison;
}

std::vector<MotionRow> concluded(const std::vector<PlayedRow>& played, const std::vector<ChosenSetting>& settings)
{
    std::vector<MotionRow> rows;
    // Frames of one clip, method, setting and member, by pose.
    struct Frames {
        std::map<std::string, double> error[2], skin_mm[2];  // by FrameGuess
        std::vector<double> ms;
    };
    std::map<std::tuple<std::string, std::string, std::string, std::string>, Frames> all;
    for (const PlayedRow& row : played) {
        Frames& frames = all[{row.clip, row.method, row.setting, row.member}];
        const int start = static_cast<int>(row.start);
        if (row.start == FrameGuess::frame_before) frames.ms.push_back(row.ms);
        if (row.error_joint_pct) frames.error[start][row.pose] = *row.error_joint_pct;
        if (row.skin_mm) frames.skin_mm[start][row.pose] = *row.skin_mm;
    }
    const auto share = [](const std::map<std::string, double>& errors, const std::map<std::string, double>& of_lbs) {
        std::vector<double> own, lbs;
        for (const auto& [pose, error] : errors)
            if (of_lbs.contains(pose)) own.push_back(error), lbs.push_back(of_lbs.at(pose));
        return analysis::share(own, lbs);
    };
    const auto mean = [](const std::map<std::string, double>& values) {
        std::vector<double> numbers;
        for (const auto& [pose, value] : values) numbers.push_back(value);
        return analysis::mean(numbers);
    };
    for (const auto& [key, frames] : all) {
        const auto& [clip, method, setting, member] = key;
        for (const ChosenSetting& chosen : settings) {
            const bool is_shown = std::ranges::count(comparison_times().tables_ms, chosen.budget_ms) > 0;
            if (!is_shown || chosen.method != method || chosen.setting != setting) continue;
            const auto lbs_setting = std::ranges::find_if(settings, [&](const ChosenSetting& chosen_setting) {
                return chosen_setting.method == baseline && chosen_setting.budget_ms == chosen.budget_ms;
            });
            if (lbs_setting == settings.end()) continue;
            const auto lbs = all.find({clip, baseline, lbs_setting->setting, member});
            if (lbs == all.end()) continue;
            const auto& of_lbs = lbs->second.error[static_cast<int>(FrameGuess::cold)];
            rows.push_back({clip, chosen.budget_ms, method, setting, member, static_cast<int>(frames.error[0].size()),
                            analysis::median(frames.ms), share(frames.error[0], of_lbs), share(frames.error[1], of_lbs),
                            mean(frames.skin_mm[0]), mean(frames.skin_mm[1])});
        }
    }
    return rows;
}

}  // namespace experiments
