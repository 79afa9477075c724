// The sentence that ends a trial, composed from its facts.
#include "experiments/trial/trial.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

namespace experiments {
namespace {

std::string shown_name(const std::string& deformer)
{
    static const std::map<std::string, std::string> names = {
        {"lbs", "LBS"}, {"dqs", "DQS"}, {"lbs_paper", "LBS with the weights of Eq. 2"}, {"delta_mush", "delta mush"}, {"pbs", "PBS"}};
    const auto named = names.find(deformer);
    return named == names.end() ? deformer : named->second;
}

// With a sign and one decimal place; + 0.0 takes the minus from a zero.
std::string per_cent(double value)
{
    return fmt::format("{:+.1f}", std::round(10.0 * value) / 10.0 + 0.0);
}

std::string volume_range(const nlohmann::json& of)
{
    const std::string lowest = per_cent(of.at("lowest_pct")), highest = per_cent(of.at("highest_pct"));
    if (lowest == highest) return lowest == "+0.0" ? "by less than 0.05 %" : fmt::format("by {} %", lowest);
    if (lowest == "+0.0" || highest == "+0.0") return fmt::format("by at most {} %", lowest == "+0.0" ? highest : lowest);
    return fmt::format("by {} to {} %", lowest, highest);
}

std::string joint_words(const nlohmann::json& joints)
{
    const auto names = joints.at("names").get<std::vector<std::string>>();
    return fmt::format("; at the {} {} by {} % instead of {} % on average", names.size() > 1 ? "joints" : "joint",
                       fmt::join(names, " and "), per_cent(joints.at("pbs_pct")), per_cent(joints.at("lbs_pct")));
}

std::string nearer_words(const nlohmann::json& nearer)
{
    const auto frames = [](const nlohmann::json& of) {
        return fmt::format("{} of {} frames", of.at("frames").get<int>(), of.at("of").get<int>());
    };
    std::string text = " PBS is nearer to FEM than LBS in " + frames(nearer);
    if (const nlohmann::json& best = nearer.at("best_other"); !best.is_null())
        text += fmt::format(", and than {}, the best of the other methods, in {}", shown_name(best.at("deformer")), frames(best));
    return text + ".";
}

std::string skin_words(const nlohmann::json& skin)
{
    const double removed_pct = std::round(skin.at("removed_pct").get<double>());
    const std::string change = removed_pct > 0.0   ? fmt::format("removes {:.0f} % of the distance", removed_pct)
                               : removed_pct < 0.0 ? fmt::format("adds {:.0f} % to the distance", -removed_pct)
                                                   : "changes the distance by less than 1 %";
    return fmt::format(" On a body of 1.7 m, the skin is {:.2g} mm from FEM with LBS and {:.2g} mm with PBS, which {}.",
                       skin.at("lbs_mm").get<double>(), skin.at("pbs_mm").get<double>(), change);
}

std::string error_bar_words(const nlohmann::json& bar)
{
    const nlohmann::json& largest_pct = bar.at("largest_pct");
    return fmt::format(" The error of FEM itself is estimated in {} of {} frames{}, which took {:.0f} s.", bar.at("frames").get<int>(),
                       bar.at("of").get<int>(), largest_pct.is_null() ? "" : fmt::format(", at most {:.2g} %", largest_pct.get<double>()),
                       bar.at("seconds").get<double>());
}

std::string time_words(const nlohmann::json& facts)
{
    std::vector<std::string> deformers = {"pbs", "lbs"}, times;
    if (const nlohmann::json& nearer = facts.at("nearer"); !nearer.is_null() && !nearer.at("best_other").is_null())
        deformers.push_back(nearer.at("best_other").at("deformer").get<std::string>());
    for (const std::string& deformer : deformers) {
        const double ms = facts.at("frame_ms").at(deformer);
        times.push_back((ms < 10.0 ? fmt::format("{:.2g} ms", ms) : fmt::format("{:.0f} ms", ms)) + " with " + shown_name(deformer));
    }
    return fmt::format(" A frame takes {}.", fmt::join(times, ", "));
}

}  // namespace

std::string trial_sentence(const nlohmann::json& facts)
{
    const nlohmann::json &volume = facts.at("volume"), &joints = facts.at("joints"), &nearer = facts.at("nearer");
    if (!volume.contains("pbs") || !volume.contains("lbs")) return "PBS or LBS broke down in every frame.";
    if (!facts.at("deforms").get<bool>())
        return "No flesh deforms: it rests or moves rigidly in every frame, so that there is nothing to compare.";
    std::string text = fmt::format("PBS changes the volume {}, LBS {}", volume_range(volume.at("pbs")), volume_range(volume.at("lbs")));
    if (!joints.is_null()) text += joint_words(joints);
    text += ".";
    if (!nearer.is_null()) text += nearer_words(nearer);
    if (const nlohmann::json& skin = facts.at("skin"); !skin.is_null()) text += skin_words(skin);
    if (const nlohmann::json& bar = facts.at("error_bar"); !bar.is_null()) text += error_bar_words(bar);
    return text + time_words(facts);
}

}  // namespace experiments
