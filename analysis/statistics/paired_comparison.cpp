#include "analysis/statistics/paired_comparison.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace analysis {
namespace {

// Poses by number, and one list of drawn poses for each replicate of the bootstrap.
using PoseList = std::vector<int>;
using Replicates = std::vector<PoseList>;

void refuse_length(const std::string& field, std::size_t length, std::size_t expected)
{
    if (length != expected)
        throw pbs::InputError("compared poses", 0, field, std::to_string(length),
                              "expected a length of " + std::to_string(expected));
}

// field: as error[member][pose]. Zero is a bound that U may have, but no error, whose logarithm is needed.
void refuse_values(const std::string& field, const std::vector<std::vector<double>>& values, const ComparedPoses& poses,
                   bool zero)
{
    refuse_length(field, values.size(), poses.members.size());
    for (const std::vector<double>& of_poses : values) {
        refuse_length(field, of_poses.size(), poses.bodies.size());
        for (const double value : of_poses)
            if (value < 0.0 || (!zero && value == 0.0) || std::isinf(value))
                throw pbs::InputError(
                    "compared poses", 0, field, pbs::number_text(value),
                    std::string("expected a finite number ") + (zero ? ">= 0" : "> 0") + ", or NaN if it is not known");
    }
}

void refuse_bad_input(const ComparedPoses& poses)
{
    refuse_values("own_error", poses.own_error, poses, true);
    for (const MethodErrors& method : poses.methods)
        refuse_values("error of " + method.method, method.error, poses, false);
}

// 0 <= index < count, each as probable as the others. std::uniform_int_distribution draws other numbers in other
// standard libraries.
std::size_t draw_index(std::mt19937_64& random, std::size_t count)
{
    // the largest multiple of count
    const std::uint64_t below = std::mt19937_64::max() - std::mt19937_64::max() % count;
    std::uint64_t value = random();
    while (value >= below) value = random();
    return static_cast<std::size_t>(value % count);
}

// As many bodies as the poses have, with replacement, and as many poses of each drawn body as it has.
Replicates draw_replicates(const PoseList& poses, const std::vector<std::string>& bodies, const PairRule& rule)
{
    std::vector<PoseList> by_body;
    std::map<std::string, std::size_t> place;
    for (const int pose : poses) {
        const auto [body, is_new] = place.try_emplace(bodies[pose], by_body.size());
        if (is_new) by_body.emplace_back();
        by_body[body->second].push_back(pose);
    }
    std::mt19937_64 random(rule.seed);
    Replicates replicates(static_cast<std::size_t>(rule.replicates));
    for (PoseList& drawn : replicates)
        for (std::size_t i = 0; i < by_body.size(); ++i) {
            const PoseList& body = by_body[draw_index(random, by_body.size())];
            for (std::size_t k = 0; k < body.size(); ++k) drawn.push_back(body[draw_index(random, body.size())]);
        }
    return replicates;
}

double mean_over(const PoseList& poses, const std::vector<double>& value)
{
    double sum = 0.0;
    for (const int pose : poses) sum += value[pose];
    return sum / static_cast<double>(poses.size());
}

// The ends of the range are order statistics, at equal distances from the least and the largest mean. Exchanging the
// methods therefore gives the reciprocals.
Interval geometric_mean(const PoseList& poses, const std::vector<double>& log_ratio, const Replicates& replicates,
                        double confidence)
{
    std::vector<double> means;
    for (const PoseList& drawn : replicates) means.push_back(mean_over(drawn, log_ratio));
    std::sort(means.begin(), means.end());
    const auto beyond = static_cast<std::size_t>((1.0 - confidence) / 2.0 * static_cast<double>(means.size()));
    return {.estimate = std::exp(mean_over(poses, log_ratio)),
            .low = std::exp(means[beyond]),
            .high = std::exp(means[means.size() - 1 - beyond]),
            .level = confidence,
            .n = static_cast<int>(poses.size())};
}

// The pairs of one member. Most of them have the same usable poses, and these share the draws of the bootstrap.
class MemberPairs {
public:
    MemberPairs(const ComparedPoses& poses, std::size_t member, const PairRule& rule)
        : poses_(poses), member_(member), rule_(rule)
    {
    }

    MemberComparison compare(const MethodErrors& first, const MethodErrors& second)
    {
        const std::vector<double>&a = first.error[member_], &b = second.error[member_], &u = poses_.own_error[member_];
        MemberComparison comparison;
        PoseList usable;
        std::vector<double> log_ratio(u.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            if (std::isnan(a[i]) || std::isnan(b[i]) || std::isnan(u[i])) continue;
            usable.push_back(static_cast<int>(i));
            log_ratio[i] = std::log(b[i]) - std::log(a[i]);
            ++(std::abs(a[i] - b[i]) <= u[i] ? comparison.ties : a[i] < b[i] ? comparison.wins : comparison.losses);
        }
        comparison.p = sign_test(comparison.wins, comparison.losses);
        if (usable.empty()) return comparison;
        const auto [drawn, is_new] = replicates_.try_emplace(usable);
        if (is_new) drawn->second = draw_replicates(usable, poses_.bodies, rule_);
        comparison.ratio = geometric_mean(usable, log_ratio, drawn->second, rule_.confidence);
        return comparison;
    }

private:
    const ComparedPoses& poses_;
    const std::size_t member_;
    const PairRule& rule_;
    std::map<PoseList, Replicates> replicates_;  // by the usable poses
};

bool is_level(const MemberComparison& member, const PairRule& rule)
{
    if (static_cast<double>(member.ties) / member.poses() >= rule.tied_share) return true;
    return std::max(member.ratio.high, 1.0 / member.ratio.low) <= rule.level_ratio;
}

// Methods by their ranks that share one letter.
using Letter = std::set<std::size_t>;

// Piepho's insertion of one pair: each letter that both methods have becomes two, one without the first and one without
// the second. Absorption: a letter goes if another one has all of its methods.
std::vector<Letter> insert_and_absorb(const std::vector<Letter>& letters, std::size_t first, std::size_t second)
{
    std::vector<Letter> split, kept;
    for (const Letter& letter : letters) {
        split.push_back(letter);
        if (!letter.contains(first) || !letter.contains(second)) continue;
        split.back().erase(first);
        split.push_back(letter);
        split.back().erase(second);
    }
    std::stable_sort(split.begin(), split.end(), [](const Letter& a, const Letter& b) { return a.size() > b.size(); });
    for (const Letter& letter : split)
        if (std::none_of(kept.begin(), kept.end(),
                         [&](const Letter& larger) { return std::ranges::includes(larger, letter); }))
            kept.push_back(letter);
    return kept;
}

}  // namespace

std::vector<MethodPair> compare_methods(const ComparedPoses& poses, const PairRule& rule)
{
    refuse_bad_input(poses);
    std::vector<MethodPair> pairs;
    std::vector<std::pair<std::size_t, std::size_t>> methods;  // of each pair
    for (std::size_t a = 0; a < poses.methods.size(); ++a)
        for (std::size_t b = a + 1; b < poses.methods.size(); ++b) {
            pairs.push_back({poses.methods[a].method, poses.methods[b].method});
            methods.emplace_back(a, b);
        }
    for (std::size_t m = 0; m < poses.members.size(); ++m) {
        MemberPairs of_member(poses, m, rule);
        std::vector<double> p;
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            pairs[k].members.push_back(
                of_member.compare(poses.methods[methods[k].first], poses.methods[methods[k].second]));
            p.push_back(pairs[k].members[m].p);
        }
        const std::vector<double> adjusted = holm(p);
        for (std::size_t k = 0; k < pairs.size(); ++k) pairs[k].members[m].p_holm = adjusted[k];
    }
    for (MethodPair& pair : pairs) pair.decision = decision_of(pair.members, rule);
    return pairs;
}

double sign_test(int wins, int losses)
{
    return std::min(1.0, 2.0 * binomial_tail(std::max(wins, losses), wins + losses, 0.5));
}

std::vector<double> holm(const std::vector<double>& p)
{
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> adjusted(p.size());
    double largest = 0.0;  // of the smaller p: an adjusted p is never below that of a smaller one
    for (std::size_t i = 0; i < order.size(); ++i) {
        largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - i) * p[order[i]]));
        adjusted[order[i]] = largest;
    }
    return adjusted;
}

MethodDecision decision_of(const std::vector<MemberComparison>& members, const PairRule& rule)
{
    int usable = 0, level = 0, first = 0, second = 0;  // numbers of members
    for (const MemberComparison& member : members) {
        if (member.poses() == 0) continue;
        ++usable;
        if (is_level(member, rule)) ++level;
        if (member.p_holm < rule.significance) ++(member.wins > member.losses ? first : second);
    }
    if (usable == 0) return MethodDecision::open;
    if (level == usable) return MethodDecision::level;
    if (first == usable) return MethodDecision::first_is_nearer;
    if (second == usable) return MethodDecision::second_is_nearer;
    return first > 0 && second > 0 ? MethodDecision::depends : MethodDecision::open;
}

std::vector<std::string> letters(const std::vector<std::string>& ranked_methods, const std::vector<MethodPair>& pairs)
{
    std::map<std::string, std::size_t> rank;
    for (const std::string& method : ranked_methods) rank.emplace(method, rank.size());
    std::vector<Letter> columns(1);
    for (std::size_t i = 0; i < ranked_methods.size(); ++i) columns[0].insert(i);
    for (const MethodPair& pair : pairs) {
        const bool is_decided =
            pair.decision == MethodDecision::first_is_nearer || pair.decision == MethodDecision::second_is_nearer;
        if (is_decided && rank.contains(pair.first) && rank.contains(pair.second))
            columns = insert_and_absorb(columns, rank[pair.first], rank[pair.second]);
    }
    std::sort(columns.begin(), columns.end());
    std::vector<std::string> display(ranked_methods.size());
    for (std::size_t k = 0; k < columns.size(); ++k)
        for (const std::size_t method : columns[k]) {
            display[method] += static_cast<char>('a' + k % 26);
            if (k >= 26) display[method] += std::to_string(k / 26 + 1);
        }
    return display;
}

double share(const std::vector<double>& error, const std::vector<double>& baseline, const std::vector<bool>& kept)
{
    std::vector<double> log_ratios;
    for (std::size_t i = 0; i < error.size(); ++i) {
        const double log_ratio = std::log(error[i]) - std::log(baseline.at(i));
        if ((kept.empty() || kept.at(i)) && !std::isnan(log_ratio)) log_ratios.push_back(log_ratio);
    }
    return std::exp(mean(log_ratios));
}

ComparedPoses selected_poses(const ComparedPoses& poses, const std::vector<bool>& kept)
{
    refuse_bad_input(poses);
    refuse_length("kept", kept.size(), poses.bodies.size());
    const auto select = [&](auto& of_poses) {
        auto selected = of_poses;
        selected.clear();
        for (std::size_t i = 0; i < kept.size(); ++i)
            if (kept[i]) selected.push_back(of_poses[i]);
        of_poses = selected;
    };
    ComparedPoses selection = poses;
    select(selection.bodies);
    for (std::vector<double>& of_poses : selection.own_error) select(of_poses);
    for (MethodErrors& method : selection.methods)
        for (std::vector<double>& of_poses : method.error) select(of_poses);
    return selection;
}

ComparedPoses without_body(const ComparedPoses& poses, const std::string& body)
{
    std::vector<bool> kept;
    for (const std::string& of_pose : poses.bodies) kept.push_back(of_pose != body);
    return selected_poses(poses, kept);
}

}  // namespace analysis
