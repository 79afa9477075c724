// The setting of each rung: chosen on the training poses, shown on the others. There are two comparisons. packed_f32 has each deformer in
// the best code that it has: packed f32, plain f32, packed f64 or plain f64, in this order. plain_f64 has each deformer in plain f64 code.
//   const std::vector<ChosenSetting> chosen = choose_settings(rows_of_all_cases);
// The chosen setting of a rung has the least geometric mean of error_joint_pct over the training poses with that rung. Only settings
// that finished in all of these poses are candidates. A single setting is no choice and needs no training. Where no training pose has the
// rung, the default setting is chosen.
#pragma once

#include "experiments/studies/work_precision/point_row.hpp"

#include <map>
#include <string>
#include <vector>

namespace experiments {

enum class Comparison { packed_f32, plain_f64 };
inline constexpr std::array<Comparison, 2> comparisons = {Comparison::packed_f32, Comparison::plain_f64};
std::string words_of(Comparison comparison);  // for headings

using CaseRows = std::vector<PointRow>;  // of one case

// The best code of each deformer, by code_rank. In packed_f32 only that code takes part.
using BestCodes = std::map<std::string, int>;
int code_rank(const SettingKey& key);  // 3: packed f32, 2: plain f32, 1: packed f64, 0: plain f64
BestCodes best_codes(const std::vector<CaseRows>& cases);
// A deformer that has no entry in `best` takes part with any code.
bool takes_part(Comparison comparison, const SettingKey& key, const BestCodes& best);

struct ChosenSetting {
    Comparison comparison;
    SettingKey key;
    int tried = 0;           // settings of this rung
    int training_poses = 0;  // that decided; 0: there was no choice, or no training pose has the rung
    std::optional<double> training_error_pct = {};
};
extern const analysis::Columns<ChosenSetting> chosen_columns;  // settings.csv

std::vector<ChosenSetting> choose_settings(const std::vector<CaseRows>& cases);

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::Comparison> {
    static constexpr std::array<std::pair<experiments::Comparison, const char*>, 2> table{
        {{experiments::Comparison::packed_f32, "packed_f32"}, {experiments::Comparison::plain_f64, "plain_f64"}}};
};

}  // namespace analysis
