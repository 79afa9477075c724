#include "experiments/studies/work_precision/chosen_settings.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

constexpr double least_error_pct = 1e-9;  // an error of zero has no logarithm

// A rung with the rows of its settings in each training pose that has it.
struct Rung {
    std::vector<SettingKey> settings;                         // in the order of the records: the default one first
    std::vector<std::vector<const PointRow*>> training = {};  // [training pose][setting]; null: no row
};

const PointRow* row_of(const CaseRows& rows, const SettingKey& key)
{
    const auto found = std::ranges::find(rows, key, &PointRow::key);
    return found == rows.end() ? nullptr : &*found;
}

Rung rung_with(const SettingKey& rung, const std::vector<SettingKey>& settings, const std::vector<CaseRows>& cases)
{
    Rung found{settings};
    for (const CaseRows& rows : cases) {
        if (rows.empty() || rows.front().half != Half::training) continue;
        if (std::ranges::none_of(rows, [&](const PointRow& row) { return rung_of(row.key) == rung; })) continue;
        std::vector<const PointRow*>& of_pose = found.training.emplace_back();
        for (const SettingKey& key : settings) of_pose.push_back(row_of(rows, key));
    }
    return found;
}

// The geometric mean over the training poses; nothing without an answer in each of them.
std::optional<double> training_error_pct(const Rung& rung, std::size_t setting)
{
    double sum = 0.0;
    for (const auto& of_pose : rung.training) {
        const PointRow* row = of_pose[setting];
        if (!row || !row->error || !row->ms_median) return std::nullopt;
        sum += std::log(std::max(row->error->joint_pct, least_error_pct));
    }
    if (rung.training.empty()) return std::nullopt;
    return std::exp(sum / double(rung.training.size()));
}

std::optional<ChosenSetting> choose(Comparison comparison, const Rung& rung)
{
    ChosenSetting chosen{comparison, rung.settings.front(), static_cast<int>(rung.settings.size())};
    if (rung.settings.size() == 1 || rung.training.empty()) return chosen;
    for (std::size_t i = 0; i < rung.settings.size(); ++i) {
        const std::optional<double> error_pct = training_error_pct(rung, i);
        if (!error_pct || (chosen.training_error_pct && *error_pct >= *chosen.training_error_pct)) continue;
        chosen.training_error_pct = error_pct;
        chosen.key = rung.settings[i];
    }
    chosen.training_poses = static_cast<int>(rung.training.size());
    return chosen.training_error_pct ? std::optional(chosen) : std::nullopt;
}

}  // namespace

const Columns<ChosenSetting> chosen_columns =
    Columns<ChosenSetting>{{"comparison", &ChosenSetting::comparison, "", "packed_f32 or plain_f64"}} +
    within(&ChosenSetting::key, point_key_columns()) +
    Columns<ChosenSetting>{
        {"tried", &ChosenSetting::tried, "", "number of settings tried at this rung"},
        {"training_poses", &ChosenSetting::training_poses, "", "poses on which it was chosen; 0: there was no choice"},
        {"training_error_joint_pct", &ChosenSetting::training_error_pct, "%", "its geometric mean error over these poses"}};

std::string words_of(Comparison comparison)
{
    return comparison == Comparison::packed_f32 ? "packed f32 code where a deformer has it" : "plain f64 code";
}

int code_rank(const SettingKey& key)
{
    return (key.precision == "f32" ? 2 : 0) + (key.packed ? 1 : 0);
}

BestCodes best_codes(const std::vector<CaseRows>& cases)
{
    BestCodes best;
    for (const CaseRows& rows : cases)
        for (const PointRow& row : rows)
            if (!row.is_of_reference()) best[row.key.deformer] = std::max(best[row.key.deformer], code_rank(row.key));
    return best;
}

bool takes_part(Comparison comparison, const SettingKey& key, const BestCodes& best)
{
    if (comparison == Comparison::plain_f64) return key.is_plain();
    const auto found = best.find(key.deformer);
    return found == best.end() || code_rank(key) == found->second;
}

std::vector<ChosenSetting> choose_settings(const std::vector<CaseRows>& cases)
{
    const BestCodes best = best_codes(cases);
    std::vector<ChosenSetting> chosen;
    for (const Comparison comparison : comparisons) {
        std::vector<std::pair<SettingKey, std::vector<SettingKey>>> rungs;  // in the order of the records
        for (const CaseRows& rows : cases)
            for (const PointRow& row : rows) {
                if (row.is_of_reference() || !takes_part(comparison, row.key, best)) continue;
                const SettingKey rung = rung_of(row.key);
                auto found = std::ranges::find(rungs, rung, [](const auto& one) { return one.first; });
                if (found == rungs.end()) found = rungs.insert(rungs.end(), {rung, {}});
                if (std::ranges::find(found->second, row.key) == found->second.end()) found->second.push_back(row.key);
            }
        for (const auto& [rung, settings] : rungs)
            if (const auto choice = choose(comparison, rung_with(rung, settings, cases))) chosen.push_back(*choice);
    }
    return chosen;
}

}  // namespace experiments
