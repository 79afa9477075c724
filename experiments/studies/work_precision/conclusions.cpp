#include "experiments/studies/work_precision/conclusions.hpp"

#include "analysis/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace experiments {

using analysis::CsvTable;
using analysis::not_known;
using Row = CsvTable::Row;

const std::vector<std::string> own_error_columns = {"pose", "body", "stratum", "member", "outcome", "own_error_pct"};

std::vector<std::string> compared_columns()
{
    std::vector<std::string> columns = {"table", "budget_ms", "method", "pose", "body", "stratum", "ms", "skin_mm"};
    std::ranges::move(member_error_columns().names(), std::back_inserter(columns));
    return columns;
}

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

const ChosenSetting* chosen_setting(const std::vector<ChosenSetting>& settings, const std::string& method,
                                    double budget_ms)
{
    const auto found = std::ranges::find_if(settings, [&](const ChosenSetting& chosen) {
        return chosen.method == method && chosen.budget_ms == budget_ms;
    });
    return found == settings.end() ? nullptr : &*found;
}

bool has_table(double budget_ms)
{
    return budget_ms == any_time_ms || std::ranges::count(comparison_times().tables_ms, budget_ms) > 0;
}

// The poses of the strata that are compared, and the rows of a method in them.
class PosesOfTable {
public:
    PosesOfTable(const CsvTable& points, const CsvTable& own)
        : points_(points.where([](const Row& row) {
              return row.has({{"stratum", Stratum::movement}}) || row.has({{"stratum", Stratum::fold}});
          }))
    {
        for (const EnsembleMember& member : family()) compared_.members.push_back(member.name);
        for (const CsvTable& of_pose : points_.groups({"pose"})) {
            place_.emplace(of_pose[0].text("pose"), place_.size());
            compared_.bodies.push_back(of_pose[0].text("body"));
            is_movement_.push_back(of_pose[0].has({{"stratum", Stratum::movement}}));
        }
        compared_.own_error.assign(compared_.members.size(), std::vector<double>(place_.size(), not_known));
        for (const Row& row : own) {
            const auto member = std::ranges::find(compared_.members, row.text("member")) - compared_.members.begin();
            if (place_.contains(row.text("pose")) && member < std::ssize(compared_.members))
                compared_.own_error[member][place_.at(row.text("pose"))] =
                    row.number_or_nothing("own_error_pct").value_or(not_known);
        }
    }

    CsvTable rows(const std::string& method, const std::string& setting, ComparisonTable table) const
    {
        const GivenFlesh flesh = table == ComparisonTable::known ? GivenFlesh::own : GivenFlesh::standard;
        return points_.where({{"method", method}, {"setting", setting}}).where([&](const Row& row) {
            return row.has({{"flesh", GivenFlesh::none}}) || row.has({{"flesh", flesh}});
        });
    }

    analysis::MethodErrors errors(const std::string& method, const CsvTable& rows) const
    {
        analysis::MethodErrors errors{method, {}};
        for (const std::string& member : compared_.members) {
            std::vector<double>& errors_pct = errors.error.emplace_back(place_.size(), not_known);
            for (const Row& row : rows)
                errors_pct[place_.at(row.text("pose"))] = row.number_or_nothing(member + "_pct").value_or(not_known);
        }
        return errors;
    }

    std::vector<std::string> external_methods() const
    {
        const CsvTable without_setting =
            points_.where({{"setting", ""}, {"flesh", GivenFlesh::none}}).where([](const Row& row) {
                return std::ranges::count(methods(), row.text("method"), &ComparedMethod::name) == 0;
            });
        std::vector<std::string> names;
        for (const CsvTable& method : without_setting.groups({"method"})) names.push_back(method[0].text("method"));
        return names;
    }

    const analysis::ComparedPoses& compared() const { return compared_; }
    const std::vector<bool>& is_movement() const { return is_movement_; }
    std::vector<bool> is_fold() const
    {
        std::vector<bool> is_fold = is_movement_;
        is_fold.flip();
        return is_fold;
    }

private:
    CsvTable points_;
    std::map<std::string, std::size_t> place_;  // of each pose
    analysis::ComparedPoses compared_;          // without methods
    std::vector<bool> is_movement_;             // #poses
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
std::optional<double> median_of(const CsvTable& rows, const std::string& column)
{
    const std::vector<double> values = rows.where("stratum", Stratum::movement).known_numbers(column);
    return values.empty() ? std::nullopt : std::optional(analysis::median(values));
}

// One method in one table at one time.
struct Entry {
    const ComparedMethod* method;  // null: of the user's own
    std::string setting;
    CsvTable rows;
    analysis::MethodErrors errors;
    Spread share = {};  // over the poses by movement
};

std::vector<Entry> entries_of(const PosesOfTable& poses, const std::vector<ChosenSetting>& settings,
                              ComparisonTable table, double budget_ms)
{
    std::vector<Entry> entries;
    const auto add = [&](const ComparedMethod* method, const std::string& name, const std::string& setting) {
        const CsvTable rows = poses.rows(name, setting, table);
        if (rows.rows() > 0) entries.push_back({method, setting, rows, poses.errors(name, rows)});
    };
    const double chosen_for_ms = std::min(budget_ms, comparison_times().budgets_ms.back());
    for (const ComparedMethod& method : methods())
        if (const ChosenSetting* chosen = chosen_setting(settings, method.name, chosen_for_ms);
            chosen && method.is_in(name_of(table)))
            add(&method, method.name, chosen->setting);
    for (const std::string& name : poses.external_methods())
        if (const auto ms = median_of(poses.rows(name, "", table), "ms"); ms && *ms <= budget_ms)
            add(nullptr, name, "");
    return entries;
}

// The times of a table. If a deformer of the user's own needs more than the longest of them, any time follows.
std::vector<double> times_of(const PosesOfTable& poses, ComparisonTable table)
{
    std::vector<double> times_ms = comparison_times().budgets_ms;
    const double longest_ms = times_ms.back();
    const bool is_slow = std::ranges::any_of(poses.external_methods(), [&](const std::string& name) {
        return median_of(poses.rows(name, "", table), "ms").value_or(0.0) > longest_ms;
    });
    if (is_slow) times_ms.push_back(any_time_ms);
    return times_ms;
}

void add_method(const Entry& entry, const Entry& lbs, const PosesOfTable& poses, ComparisonTable table,
                double budget_ms, const std::string& letters, CsvTable& to)
{
    const std::vector<std::string> takes = entry.method ? entry.method->takes : std::vector<std::string>{};
    const std::optional<double> ms = median_of(entry.rows, "ms");
    const std::vector<int> compared = compared_poses(entry.errors, lbs.errors, poses.is_movement());
    const Spread fold = share_of(entry.errors, lbs.errors, poses.is_fold());
    const auto or_nothing = [](double value) { return std::isnan(value) ? std::nullopt : std::optional(value); };
    const CsvTable inverted = entry.rows.where([](const Row& row) {
        return row.has({{"stratum", Stratum::movement}}) && row.integer("inverted") > 0;
    });
    to.add({{"table", table},
            {"budget_ms", budget_ms},
            {"method", entry.errors.method},
            {"takes", analysis::CellOf<std::vector<std::string>>::cell(takes)},
            {"setting", entry.setting},
            {"ms", ms},
            {"times_pbs", median_of(entry.rows, "times_pbs")},
            {"within", 2.0 * ms.value_or(0.0) <= budget_ms ? "doubled"
                       : ms.value_or(0.0) <= budget_ms     ? "once"
                                                           : "no"},
            {"poses", std::ranges::max(compared)},
            {"fewest_poses", std::ranges::min(compared)},
            {"share", entry.share.middle},
            {"share_low", entry.share.low},
            {"share_high", entry.share.high},
            {"fold_share", or_nothing(fold.middle)},
            {"fold_low", or_nothing(fold.low)},
            {"fold_high", or_nothing(fold.high)},
            {"skin_mm", median_of(entry.rows, "skin_mm")},
            {"inverted_poses", inverted.rows()},
            {"letters", letters}});
}

// The pairs of a table at one time, and what each body changes.
std::vector<analysis::MethodPair> add_pairs(const std::vector<Entry>& entries, const PosesOfTable& poses,
                                            ComparisonTable table, double budget_ms, Comparison& comparison)
{
    analysis::ComparedPoses with_methods = poses.compared();
    for (const Entry& entry : entries) with_methods.methods.push_back(entry.errors);
    const analysis::ComparedPoses movement = analysis::selected_poses(with_methods, poses.is_movement());
    const std::vector<analysis::MethodPair> pairs = analysis::compare_methods(movement);
    const auto add_decisions = [&](const std::vector<analysis::MethodPair>& method_pairs,
                                   const std::string& without_body) {
        for (const analysis::MethodPair& pair : method_pairs)
            comparison.decisions.add_row({table, budget_ms, without_body, pair.first, pair.second, pair.decision});
    };
    for (const analysis::MethodPair& pair : pairs)
        for (std::size_t m = 0; m < pair.members.size(); ++m) {
            const analysis::MemberComparison& on = pair.members[m];
            if (on.poses() == 0) continue;
            comparison.pairs.add_row({table, budget_ms, pair.first, pair.second, movement.members[m], on.wins, on.ties,
                                      on.losses, on.p, on.p_holm, on.ratio.estimate, on.ratio.low, on.ratio.high});
        }
    add_decisions(pairs, "");
    for (const std::string& body : std::set<std::string>(movement.bodies.begin(), movement.bodies.end()))
        add_decisions(analysis::compare_methods(analysis::without_body(movement, body)), body);
    return pairs;
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

void add_table(std::vector<Entry> entries, const Entry& lbs, const PosesOfTable& poses, ComparisonTable table,
               double budget_ms, Comparison& comparison)
{
    for (const Entry& entry : entries)
        for (const Row& point : entry.rows) {
            std::vector<CsvTable::Cell> cells = {table, budget_ms};
            for (std::size_t c = cells.size(); c < comparison.errors.columns().size(); ++c)
                cells.emplace_back(point.text(comparison.errors.columns()[c]));
            comparison.errors.add_row(cells);
        }
    const std::vector<analysis::MethodPair> pairs = add_pairs(entries, poses, table, budget_ms, comparison);
    std::ranges::stable_sort(entries, {}, [](const Entry& entry) { return entry.share.middle; });
    std::vector<std::string> ranked;
    for (const Entry& entry : entries) ranked.push_back(entry.errors.method);
    const std::vector<std::string> letters = analysis::letters(ranked, pairs);
    for (std::size_t i = 0; i < entries.size(); ++i)
        add_method(entries[i], lbs, poses, table, budget_ms, letters[i], comparison.methods);
}

// The cells that are not empty.
using ValueByPose = std::map<std::string, double>;
ValueByPose by_pose(const CsvTable& rows, const std::string& column)
{
    ValueByPose values;
    for (const auto& [pose, row] : rows.by("pose"))
        if (const auto value = row.number_or_nothing(column)) values.emplace(pose, *value);
    return values;
}

// Over the poses that both have.
double share_over_poses(const ValueByPose& errors, const ValueByPose& of_lbs)
{
    std::vector<double> own, lbs;
    for (const auto& [pose, error] : errors) {
        if (!of_lbs.contains(pose)) continue;
        own.push_back(error);
        lbs.push_back(of_lbs.at(pose));
    }
    return analysis::share(own, lbs);
}

void add_starts(const CsvTable& points, const std::vector<ChosenSetting>& settings, CsvTable& to)
{
    const auto errors_of = [&](const std::string& method, const ChosenSetting* chosen, GivenFlesh flesh) {
        return by_pose(points.where({{"method", method}, {"setting", chosen->setting}, {"flesh", flesh}}),
                       family().front().name + "_pct");
    };
    for (const double budget_ms : comparison_times().tables_ms) {
        const ChosenSetting* of_lbs = chosen_setting(settings, baseline, budget_ms);
        if (!of_lbs) continue;
        const ValueByPose lbs = errors_of(baseline, of_lbs, GivenFlesh::none);
        for (const OtherStart& start : other_starts()) {
            const ChosenSetting* setting = chosen_setting(settings, start.of, budget_ms);
            if (!setting) continue;
            const ValueByPose changed = errors_of(start.name, setting, GivenFlesh::start);
            if (changed.empty()) continue;
            ValueByPose unchanged = errors_of(start.of, setting, GivenFlesh::own);
            unchanged.merge(errors_of(start.of, setting, GivenFlesh::none));
            std::erase_if(unchanged, [&](const auto& pose) { return !changed.contains(pose.first); });
            to.add_row({budget_ms, start.name, start.of, changed.size(), share_over_poses(changed, lbs),
                        share_over_poses(unchanged, lbs)});
        }
    }
}

}  // namespace

Comparison concluded(const CsvTable& points, const CsvTable& own, const std::vector<ChosenSetting>& settings)
{
    Comparison comparison;
    const PosesOfTable poses(points, own);
    for (const ComparisonTable table : {ComparisonTable::known, ComparisonTable::guessed})
        for (const double budget_ms : times_of(poses, table)) {
            std::vector<Entry> entries = entries_of(poses, settings, table, budget_ms);
            const auto found =
                std::ranges::find(entries, baseline, [](const Entry& entry) { return entry.errors.method; });
            if (found == entries.end()) continue;
            const Entry lbs = *found;
            for (Entry& entry : entries) {
                const std::string& method = entry.errors.method;
                entry.share = share_of(entry.errors, lbs.errors, poses.is_movement());
                comparison.curves.add_row({table, method, budget_ms, entry.setting,
                                           median_of(entry.rows, "ms").value_or(not_known), entry.share.middle,
                                           entry.share.low, entry.share.high});
                if (budget_ms == any_time_ms) continue;  // a profile is a function of the time
                for (const double target_pct : targets_pct)
                    comparison.profiles.add_row(
                        {table, target_pct, method, budget_ms, solved_pct(entry, lbs, poses, target_pct)});
            }
            if (has_table(budget_ms)) add_table(std::move(entries), lbs, poses, table, budget_ms, comparison);
        }
    add_starts(points, settings, comparison.starts);
    return comparison;
}

CsvTable concluded_motion(const CsvTable& played, const std::vector<ChosenSetting>& settings)
{
    CsvTable motion({"clip", "budget_ms", "method", "setting", "member", "frames", "ms", "cold_share", "played_share",
                     "cold_skin_mm", "played_skin_mm"},
                    "motion.csv");
    const auto values = [](const CsvTable& frames, FrameGuess start, const char* column) {
        return by_pose(frames.where("start", start), column);
    };
    const auto mean = [](const ValueByPose& of_pose) {
        std::vector<double> numbers;
        for (const auto& [pose, value] : of_pose) numbers.push_back(value);
        return analysis::mean(numbers);
    };
    std::vector<CsvTable> all = played.groups({"clip", "method", "setting", "member"});
    std::ranges::sort(all, {}, [](const CsvTable& of) {
        return std::tuple(of[0].text("clip"), of[0].text("method"), of[0].text("setting"), of[0].text("member"));
    });
    using enum FrameGuess;
    for (const CsvTable& frames : all)
        for (const ChosenSetting& chosen : settings) {
            const std::string &clip = frames[0].text("clip"), &member = frames[0].text("member");
            if (!has_table(chosen.budget_ms) ||
                !frames[0].has({{"method", chosen.method}, {"setting", chosen.setting}}))
                continue;
            const ChosenSetting* of_lbs = chosen_setting(settings, baseline, chosen.budget_ms);
            if (!of_lbs) continue;
            const CsvTable lbs =
                played.where({{"clip", clip}, {"method", baseline}, {"setting", of_lbs->setting}, {"member", member}});
            if (lbs.rows() == 0) continue;
            const ValueByPose cold_of_lbs = values(lbs, cold, "error_joint_pct"),
                              cold_errors = values(frames, cold, "error_joint_pct");
            motion.add_row({clip, chosen.budget_ms, chosen.method, chosen.setting, member, cold_errors.size(),
                            analysis::median(frames.where("start", frame_before).numbers("ms")),
                            share_over_poses(cold_errors, cold_of_lbs),
                            share_over_poses(values(frames, frame_before, "error_joint_pct"), cold_of_lbs),
                            mean(values(frames, cold, "skin_mm")), mean(values(frames, frame_before, "skin_mm"))});
        }
    return motion;
}

std::vector<ChosenSetting> chosen_settings(const CsvTable& training)
{
    const std::vector<CsvTable> tried = training.groups({"method", "setting"});
    const auto finished_poses = [](const CsvTable& rows) { return rows.where("outcome", "finished").rows(); };
    int poses = 0;  // a ladder that ended early on one body, or a shape that is not finite, has fewer
    for (const CsvTable& rows : tried) poses = std::max(poses, finished_poses(rows));
    std::vector<ChosenSetting> sound;  // without a budget, and with the logarithm of the error
    for (const CsvTable& rows : tried) {
        std::vector<double> log_error;
        for (const Row& row : rows)
            for (const EnsembleMember& member : family())
                if (const auto error = row.number_or_nothing(member.name + "_pct"))
                    log_error.push_back(std::log(*error));
        if (finished_poses(rows) == poses && !log_error.empty())
            sound.push_back({0.0, rows[0].text("method"), rows[0].text("setting"),
                             analysis::mean(rows.known_numbers("ms")), analysis::mean(log_error)});
    }
    std::vector<ChosenSetting> chosen;
    for (const ComparedMethod& method : methods())
        for (const double budget_ms : comparison_times().budgets_ms) {
            const ChosenSetting* best = nullptr;
            for (const ChosenSetting& one : sound)
                if (one.method == method.name && !(one.training_ms > budget_ms) &&
                    (!best || one.training_error_pct < best->training_error_pct))
                    best = &one;
            if (best)
                chosen.push_back(
                    {budget_ms, method.name, best->setting, best->training_ms, std::exp(best->training_error_pct)});
        }
    return chosen;
}

}  // namespace experiments
