// Which of two methods is nearer to a reference, decided by pairs over many poses and over several references, the
// members of a family.
//   // each pair of methods, with its decision
//   const std::vector<MethodPair> pairs = compare_methods(poses);
//   // for example "a", "ab", "b"
//   const std::vector<std::string> shared = letters({"vbd", "pbs", "delta_mush"}, pairs);
//
// On each member and in each pose, the method with the smaller error wins. The pose is a tie where the two errors
// differ by no more than U. U is a cautious estimate of the reference's own error: 0.6 of a distance of which the error
// is at most 0.43, where this share was measured. A difference beyond U is therefore taken as real. A pose is skipped
// where an error or U is not known. The exact sign test over the poses without ties gives p, with two sides (W. Dixon,
// A. Mood, The statistical sign test, J. Am. Stat. Assoc. 41, 1946).
//
// A table with many pairs finds differences by chance. Holm's adjustment over all pairs of the table keeps the
// probability of any wrong direction on a member below the significance (S. Holm, A simple sequentially rejective
// multiple test procedure, Scand. J. Stat. 6, 1979). The number of members needs no further correction, because a pair
// is decided only if all members agree. Such an intersection-union test errs at most as often as the test on a single
// member on which the methods do not differ (R. Berger, Multiparameter hypothesis testing and acceptance sampling,
// Technometrics 24, 1982). For the table as a whole this holds if the pairs that do not differ do so on a common
// member.
//
// The bodies are few and their poses are alike, so that a test over poses speaks for these bodies alone. A test over
// five bodies cannot have p below 2 / 2^5 = 0.0625. `without_body` shows what a decision owes to one of them.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace analysis {

struct MethodErrors {
    std::string method;
    std::vector<std::vector<double>> error = {};  // #members x #poses, positive, in any unit; NaN: not measured
};

struct ComparedPoses {
    std::vector<std::string> members = {};  // the references
    std::vector<std::string> bodies = {};   // the body of each pose
    // U of the reference, #members x #poses, in the unit of the errors; NaN: not known
    std::vector<std::vector<double>> own_error = {};
    std::vector<MethodErrors> methods = {};  // one table: methods that are compared with each other
};

// The thresholds of a decision, with their reasons.
struct PairRule {
    double significance = 0.05;  // an adjusted p below it shows a difference
    double tied_share = 0.8;   // poses that must be ties for two methods to be level: four in five cannot be told apart
    double level_ratio = 1.1;  // or the largest ratio, whichever method is first: a tenth of an error is not seen
    double confidence = 0.95;  // of the range of the ratio
    int replicates = 2000;     // of the bootstrap, at least 1: fifty of them lie beyond each end of the range
    std::uint64_t seed = 20140528;
};

// Two methods on one member.
struct MemberComparison {
    int wins = 0, ties = 0, losses = 0;  // poses in which the first method is nearer, as near, farther
    double p = 1.0, p_holm = 1.0;        // of the sign test, and adjusted for all pairs of the table
    // Geometric mean over the poses of the second method's error over the first one's; above 1 the first is nearer. The
    // range is a percentile bootstrap, which draws bodies with replacement, then poses of each drawn body. NaN where no
    // pose is usable.
    Interval ratio = {not_known, not_known, not_known};

    int poses() const { return wins + ties + losses; }
};

// The first rule that applies decides. Members without any usable pose have no say.
enum class MethodDecision {
    level,             // on every member: enough ties, or the range of the ratio within 1 / level_ratio to level_ratio
    first_is_nearer,   // on every member p_holm < significance, with more wins than losses
    second_is_nearer,  // on every member p_holm < significance, with more losses than wins
    depends,           // p_holm < significance in one direction on a member and in the other on another
    open,              // everything else, and no member with a usable pose
};

struct MethodPair {
    std::string first, second;
    std::vector<MemberComparison> members = {};  // as ComparedPoses::members
    MethodDecision decision = MethodDecision::open;
};

// All pairs of methods, each with the earlier one first. An InputError refuses errors that are not positive and lists
// of other lengths. The same input gives the same numbers to the bit, and the range of a ratio depends on its own
// usable poses alone.
std::vector<MethodPair> compare_methods(const ComparedPoses& poses, const PairRule& rule = {});

// The steps of the comparison.
double sign_test(int wins, int losses);                  // exact p with two sides; 1 without wins and losses
std::vector<double> holm(const std::vector<double>& p);  // adjusted p, each at its place
MethodDecision decision_of(const std::vector<MemberComparison>& members, const PairRule& rule = {});

// Compact letter display by insertion and absorption (H.-P. Piepho, An algorithm for a letter-based representation of
// all-pairwise comparisons, J. Comput. Graph. Stat. 13, 2004): two methods share a letter if and only if neither of
// them is nearer. 'a' is a letter of the first method of the ranking; after 'z' follow a2, b2 and so on. Pairs with a
// method that is not ranked are ignored.
std::vector<std::string> letters(const std::vector<std::string>& ranked_methods, const std::vector<MethodPair>& pairs);

// What a method leaves of the baseline's error: the geometric mean of error / baseline over the poses that have both.
//   share(pbs.error[m], lbs.error[m], is_movement);   // 0.57 on member m
// error, baseline, kept: #poses; without `kept`, all poses. NaN where no pose is left.
double share(const std::vector<double>& error, const std::vector<double>& baseline, const std::vector<bool>& kept = {});

// Only the poses that are kept, #poses; all of them except those of one body.
ComparedPoses selected_poses(const ComparedPoses& poses, const std::vector<bool>& kept);
ComparedPoses without_body(const ComparedPoses& poses, const std::string& body);

template <>
struct EnumNames<MethodDecision> {
    static constexpr std::array<std::pair<MethodDecision, const char*>, 5> table{
        {{MethodDecision::level, "level"},
         {MethodDecision::first_is_nearer, "first_is_nearer"},
         {MethodDecision::second_is_nearer, "second_is_nearer"},
         {MethodDecision::depends, "depends"},
         {MethodDecision::open, "open"}}};
};

}  // namespace analysis
