// Reference: the definitions, evaluated by hand: ties, empty tables, and thresholds that a number meets exactly. The
// kept tables of the comparison check the rest (tests/regression/experiments/kept_values.cpp). The attack at the
// end draws the labels of the methods, for which the true answer is known.

#include "analysis/statistics/paired_comparison.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace {

using namespace analysis;

constexpr double unknown = not_known;
const std::string limb = "limb";

using Errors = std::vector<double>;  // of each pose

// Two methods on one member, in poses of one body.
ComparedPoses two_methods(const Errors& first, const Errors& second, const Errors& own_error)
{
    return {{"smooth"}, std::vector<std::string>(first.size(), limb), {own_error}, {{"A", {first}}, {"B", {second}}}};
}

MemberComparison only_comparison(const ComparedPoses& poses)
{
    const std::vector<MethodPair> pairs = compare_methods(poses);
    EXPECT_EQ(pairs.size(), 1u);
    return pairs.at(0).members.at(0);
}

// Methods A, B, ... whose errors scatter by half of their size around the given factors, on members of different
// scales, in poses of four bodies.
ComparedPoses random_poses(const Errors& factors, int members, int count, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    ComparedPoses poses;
    for (int i = 0; i < count; ++i) poses.bodies.push_back("body_" + std::to_string(i % 4));
    for (const double factor : factors) {
        poses.methods.push_back({std::string(1, static_cast<char>('A' + poses.methods.size()))});
        for (int m = 0; m < members; ++m) {
            poses.methods.back().error.emplace_back();
            for (int i = 0; i < count; ++i)
                poses.methods.back().error.back().push_back(factor * (m + 1) * std::exp(0.5 * normal(random)));
        }
    }
    for (int m = 0; m < members; ++m) {
        poses.members.push_back("member_" + std::to_string(m));
        poses.own_error.emplace_back(count, 0.02 * (m + 1));
    }
    return poses;
}

TEST(SignTest, OfAsManyWinsAsLossesAndOfNoneIsOne)
{
    for (const auto& [wins, losses] : {std::pair(4, 4), {1, 0}, {0, 0}})
        EXPECT_EQ(sign_test(wins, losses), 1.0) << wins;
}

TEST(Holm, OfEqualNumbersOfOneAndOfNone)
{
    EXPECT_EQ(holm({0.6, 0.7}), (Errors{1.0, 1.0}));
    EXPECT_EQ(holm({0.25, 0.25}), (Errors{0.5, 0.5}));
    EXPECT_EQ(holm({0.25}), (Errors{0.25}));
    EXPECT_TRUE(holm({}).empty());
}

TEST(MemberComparison, CountsTiesWithinTheErrorOfTheReference)
{
    const MemberComparison comparison =
        only_comparison(two_methods({1, 2, 3, 4, 5}, {3, 3, 3, 3, 2}, {1, 1, 0, 0.5, 2.5}));
    EXPECT_EQ(comparison.wins, 1);    // 1 against 3
    EXPECT_EQ(comparison.ties, 2);    // 2 against 3, as far apart as U; 3 against 3
    EXPECT_EQ(comparison.losses, 2);  // 4 against 3, 5 against 2
}

MemberComparison member(int wins, int ties, int losses, double p_holm, double low, double high)
{
    return {wins, ties, losses, p_holm, p_holm, {std::sqrt(low * high), low, high}};
}

// On each member: a clear difference, none, near ratios, and ties.
const MemberComparison first_nearer = member(30, 5, 5, 0.001, 1.3, 1.9),
                       second_nearer = member(5, 5, 30, 0.001, 0.5, 0.8), not_shown = member(15, 15, 10, 0.6, 0.7, 1.4),
                       close = member(30, 5, 5, 0.001, 1.01, 1.09), close_below = member(5, 5, 30, 0.001, 0.92, 0.99),
                       tied = member(8, 32, 0, 0.01, 0.9, 1.5), not_quite_tied = member(9, 31, 0, 0.06, 0.9, 1.5),
                       unusable = MemberComparison{};

// Whether methods are level does not depend on which one is first: the reciprocal of 0.905 is 1.105, which is
// above 1.1.
TEST(Decision, FollowsTheFirstRuleThatApplies)
{
    using enum MethodDecision;
    struct Case {
        const char* name;
        std::vector<MemberComparison> members;
        MethodDecision decision;
        PairRule rule = {};
    };
    const auto ratio_from = [](double low, double high) { return std::vector{member(20, 0, 20, 1.0, low, high)}; };
    for (const auto& [name, members, decision, rule] :
         std::vector<Case>{{"all members agree", {first_nearer, first_nearer}, first_is_nearer},
                           {"all members agree on the second", {second_nearer, second_nearer}, second_is_nearer},
                           {"one does not show it", {first_nearer, not_shown}, open},
                           {"two contradict each other", {first_nearer, not_shown, second_nearer}, depends},
                           {"nearer by less than a tenth", {close, close}, level},
                           {"level on one member, nearer on another", {close, first_nearer}, first_is_nearer},
                           {"close on both sides of 1", {close, close_below}, level},
                           {"four of five poses are ties", {tied, close}, level},
                           {"three of four poses are ties", {not_quite_tied, close}, open},
                           {"p is the threshold itself", {member(20, 0, 9, 0.05, 1.1, 1.5)}, open},
                           {"a member without a pose has no say", {unusable, first_nearer}, first_is_nearer},
                           {"nothing is known", {unusable, unusable}, open},
                           {"no member", {}, open},
                           {"close, but not to the reciprocal", ratio_from(0.905, 0.99), open},
                           {"its reciprocal", ratio_from(1.0 / 0.99, 1.0 / 0.905), open},
                           {"close", ratio_from(0.915, 1.09), level},
                           {"the reciprocal", ratio_from(1.0 / 1.09, 1.0 / 0.915), level},
                           {"close on one side", ratio_from(0.915, 1.12), open},
                           {"another significance", {first_nearer}, open, {.significance = 0.0005}},
                           {"another share of ties", {not_quite_tied}, level, {.tied_share = 0.75}},
                           {"another ratio", {close}, first_is_nearer, {.level_ratio = 1.05}},
                           {"another ratio below 1", {close_below}, second_is_nearer, {.level_ratio = 1.05}}})
        EXPECT_EQ(recorded_name(decision_of(members, rule)), recorded_name(decision)) << name;
}

TEST(CompareMethods, OfNothingDecidesNothing)
{
    EXPECT_TRUE(compare_methods({}).empty());
    EXPECT_TRUE(compare_methods({{"smooth"}, {limb}, {{0.1}}, {{"A", {{1.0}}}}}).empty());
    EXPECT_EQ(compare_methods({{}, {limb}, {}, {{"A"}, {"B"}}}).at(0).decision, MethodDecision::open);
    const MethodPair pair = compare_methods(two_methods({}, {}, {})).at(0);
    EXPECT_EQ(pair.decision, MethodDecision::open);
    EXPECT_EQ(pair.members.at(0).poses(), 0);
    EXPECT_EQ(pair.members.at(0).p, 1.0);
    EXPECT_TRUE(std::isnan(pair.members.at(0).ratio.low));
}

TEST(CompareMethods, RefusesTablesThatDoNotFit)
{
    const auto refused = [](const std::string& message, const ComparedPoses& poses) {
        test_support::expect_refused(message, [&] { compare_methods(poses); });
    };
    refused("error of B = 2: expected a length of 3", two_methods({1, 2, 3}, {1, 2}, {0, 0, 0}));
    refused("own_error = 1: expected a length of 2", two_methods({1, 2}, {1, 2}, {0}));
    refused("error of A = 0: expected a finite number > 0", two_methods({0}, {1}, {0}));
    refused("own_error = -1: expected a finite number >= 0", two_methods({1}, {1}, {-1}));
    ComparedPoses no_member = two_methods({1}, {1}, {0});
    no_member.members.clear();
    refused("own_error = 1: expected a length of 0", no_member);
}

TEST(Share, LeavesOutWhatIsNotKnownAndIsUnknownOfNothing)
{
    EXPECT_DOUBLE_EQ(share({2, 8, unknown, 1}, {1, 2, 3, unknown}), std::sqrt(2.0 * 4.0));
    EXPECT_TRUE(std::isnan(share({1}, {1}, {false})));
    EXPECT_TRUE(std::isnan(share({}, {})));
}

MethodPair decided(const std::string& first, const std::string& second)
{
    return {first, second, {}, MethodDecision::first_is_nearer};
}

TEST(Letters, FollowTheRankingWhicheverMethodIsTheFirstOfAPair)
{
    using Names = std::vector<std::string>;
    EXPECT_EQ(letters({"C", "B", "A"}, {{"A", "C", {}, MethodDecision::second_is_nearer}}), (Names{"a", "ab", "b"}));
    for (const MethodDecision shared : {MethodDecision::level, MethodDecision::open, MethodDecision::depends})
        EXPECT_EQ(letters({"A", "B"}, {{"A", "B", {}, shared}}), (Names{"a", "a"}));
    EXPECT_EQ(letters({"A"}, {decided("A", "not_ranked")}), (Names{"a"}));
    EXPECT_TRUE(letters({}, {decided("A", "B")}).empty());
}

// The definition: two methods share a letter if and only if their pair is not decided, and no letter is another one's
// part.
TEST(Letters, AreSharedWhereAPairIsNotDecided)
{
    std::mt19937 random(5);
    for (int repetition = 0; repetition < 200; ++repetition) {
        std::vector<std::string> methods;
        std::vector<MethodPair> pairs;
        for (int b = 0; b < 8; ++b) {
            for (const std::string& method : methods)
                if (random() % 10 < static_cast<unsigned>(repetition % 10))
                    pairs.push_back(decided(method, std::string(1, 'A' + b)));
            methods.emplace_back(1, 'A' + b);
        }
        const std::vector<std::string> display = letters(methods, pairs);
        std::map<char, std::set<std::size_t>> columns;
        for (std::size_t i = 0; i < methods.size(); ++i)
            for (const char letter : display[i]) columns[letter].insert(i);
        EXPECT_EQ(display[0][0], 'a');
        for (std::size_t a = 0; a < methods.size(); ++a)
            for (std::size_t b = a + 1; b < methods.size(); ++b) {
                const bool is_shared = display[a].find_first_of(display[b]) != std::string::npos;
                EXPECT_NE(is_shared, std::any_of(pairs.begin(), pairs.end(), [&](const MethodPair& pair) {
                              return pair.first == methods[a] && pair.second == methods[b];
                          }));
            }
        for (const auto& [letter, column] : columns)
            for (const auto& [other, larger] : columns)
                EXPECT_TRUE(letter == other ||
                            !std::includes(larger.begin(), larger.end(), column.begin(), column.end()));
    }
}

TEST(Letters, ContinueAfterZ)
{
    std::vector<std::string> methods;
    std::vector<MethodPair> pairs;
    for (int i = 0; i < 28; ++i) {
        for (const std::string& nearer : methods) pairs.push_back(decided(nearer, std::to_string(i)));
        methods.push_back(std::to_string(i));
    }
    const std::vector<std::string> display = letters(methods, pairs);
    EXPECT_EQ(display[25], "z");
    EXPECT_EQ(display[26], "a2");
    EXPECT_EQ(display[27], "b2");
}

// If the labels are drawn in each pose, the same for all members, no method is nearer. Holm bounds the probability of
// any decision in the table by 5 %, so that fewer than 1 in 100 of its ten pairs are decided. Unadjusted, four in 100
// would be. The members have the same poses and errors that go with each other, as references of one family do: their
// number must not be what keeps the rate low.
TEST(Attack, LabelsDrawnAtRandomDecideFewPairs)
{
    constexpr int permutations = 2000, methods = 5, count = 40, members = 3;
    const PairRule no_bootstrap = {.level_ratio = 1.0, .replicates = 1};
    ComparedPoses poses = random_poses({1.0, 1.5, 2.2, 3.3, 5.0}, members, count, 41);
    for (MethodErrors& method : poses.methods)
        for (int m = 1; m < members; ++m)
            for (int i = 0; i < count; ++i) method.error[m][i] = (m + 1) * method.error[0][i];
    std::mt19937 random(42);
    int all = 0, decided_pairs = 0, unadjusted = 0;
    for (int repetition = 0; repetition < permutations; ++repetition) {
        for (int i = 0; i < count; ++i)
            for (int a = methods - 1; a > 0; --a) {
                const std::size_t b = random() % static_cast<unsigned>(a + 1);
                for (int m = 0; m < members; ++m) std::swap(poses.methods[a].error[m][i], poses.methods[b].error[m][i]);
            }
        for (const MethodPair& pair : compare_methods(poses, no_bootstrap)) {
            ++all;
            decided_pairs +=
                pair.decision == MethodDecision::first_is_nearer || pair.decision == MethodDecision::second_is_nearer;
            unadjusted += pair.members[0].p < no_bootstrap.significance;
        }
    }
    EXPECT_EQ(all, 10 * permutations);
    EXPECT_LE(decided_pairs, all / 100);
    EXPECT_GT(decided_pairs, 0);  // the test can fail
    EXPECT_GT(unadjusted, 2 * all / 100);
}

}  // namespace
