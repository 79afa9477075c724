// The summary of a trial, composed from its facts.
#include "experiments/trial/trial.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>

namespace experiments {
namespace {

std::string shown_name(const std::string& deformer)
{
    static const std::map<std::string, std::string> names = {{"lbs", "LBS"},
                                                             {"dqs", "DQS"},
                                                             {"lbs_paper", "LBS with the weights of Eq. 2"},
                                                             {"delta_mush", "delta mush"},
                                                             {"pbs", "PBS"}};
    const auto named = names.find(deformer);
    return named == names.end() ? deformer : named->second;
}

// With a sign and one decimal place; + 0.0 takes the minus from a zero.
std::string per_cent(double value)
{
    return fmt::format("{:+.1f}", std::round(10.0 * value) / 10.0 + 0.0);
}

std::string volume_range(const nlohmann::json& change)
{
    const std::string lowest = per_cent(change.at("lowest_pct")), highest = per_cent(change.at("highest_pct"));
    if (lowest == highest) return lowest == "+0.0" ? "by less than 0.05 %" : fmt::format("by {} %", lowest);
    if (lowest == "+0.0" || highest == "+0.0")
        return fmt::format("by at most {} %", lowest == "+0.0" ? highest : lowest);
    return fmt::format("by {} to {} %", lowest, highest);
}

std::string joint_words(const nlohmann::json& joints)
{
    const auto names = joints.at("names").get<std::vector<std::string>>();
    return fmt::format("At the {} {}, PBS changes the volume by {} % on average, LBS by {} %. ",
                       names.size() > 1 ? "joints" : "joint", fmt::join(names, " and "), per_cent(joints.at("pbs_pct")),
                       per_cent(joints.at("lbs_pct")));
}

std::string time_of(const std::string& deformer, const nlohmann::json& facts)
{
    const double ms = facts.at("frame_ms").at(deformer);
    return ms < 10.0 ? fmt::format("{:.2g} ms", ms) : fmt::format("{:.0f} ms", ms);
}

// 12, 8.4
std::string two_digits(const nlohmann::json& value)
{
    return value >= 99.5 ? fmt::format("{:.0f}", value.get<double>()) : fmt::format("{:.2g}", value.get<double>());
}

std::string tets(const nlohmann::json& count)
{
    return fmt::format("{} {}", count.get<long long>(), count.get<long long>() == 1 ? "tet" : "tets");
}

std::string capitalised(std::string text)
{
    if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string doubt_words(const nlohmann::json& facts)
{
    if (facts.at("doubtful_reference") == "lag") {
        const nlohmann::json& lag = facts.at("reference_lag");
        return fmt::format(
            "No method is called nearest: in the reference, flesh that {} alone moves lags behind it by {} degrees in "
            "frame {}. In {} of "
            "{} "
            "frames, 1 % of the body or more lag by more than 5 degrees. Finer tets (--vertices) or weights of 1 in a "
            "wider band let tets "
            "belong to that bone alone. ",
            lag.at("bone").get<std::string>(), two_digits(lag.at("largest_turn_deg")), lag.at("frame").get<int>(),
            lag.at("lagging_frames").get<int>(), lag.at("frames").get<int>());
    }
    return fmt::format(
        "No method is called nearest: the reference lies elsewhere, {} % from the nearest of them (the median over the "
        "frames). A frequent "
        "cause is flesh that hangs free of the bones, such as a cape or a skirt: give it the weights of one bone, or "
        "leave it out. ",
        two_digits(facts.at("nearest").at("methods").front().at("median_pct")));
}

// "Delta mush is nearest to FEM (12 %, in 7 of 9 frames), PBS next (18 %). "
std::string ranking_words(const nlohmann::json& nearest)
{
    const nlohmann::json& methods = nearest.at("methods");
    if (methods.empty()) return "No method is called nearest: each of them turns too many tets inside out. ";
    const nlohmann::json& best = methods.front();
    std::string text = fmt::format("{} is nearest to FEM ({} % {}, in {} of {} frames)",
                                   shown_name(best.at("deformer")), two_digits(best.at("median_pct")),
                                   nearest.at("place") == "joints" ? "at the joints" : "over the body",
                                   best.at("nearest_in").get<int>(), nearest.at("frames").get<int>());
    if (methods.size() > 1)
        text += fmt::format(", {} next ({} %)", shown_name(methods[1].at("deformer")),
                            two_digits(methods[1].at("median_pct")));
    return capitalised(text) + ". ";
}

// "Delta mush turns up to 20 tets (0.4 %) inside out, LBS 33. "
std::string inverting_words(const nlohmann::json& inverting)
{
    std::string text, excluded;
    for (const auto& [deformer, of] : inverting.items()) {
        const std::string share = two_digits(of.at("share_of_tets_pct"));
        text += text.empty() ? fmt::format("{} turns up to {} ({} %) inside out", shown_name(deformer),
                                           tets(of.at("most_inverted_tets")), share)
                             : fmt::format(", {} {} ({} %)", shown_name(deformer),
                                           of.at("most_inverted_tets").get<long long>(), share);
        if (of.at("is_excluded").get<bool>()) excluded += (excluded.empty() ? "" : ", ") + shown_name(deformer);
    }
    if (!excluded.empty()) excluded = fmt::format("Excluded for inverted tets: {}. ", excluded);
    return text.empty() ? "" : capitalised(text) + ". " + excluded;
}

std::string error_bar_words(const nlohmann::json& bar)
{
    const nlohmann::json& largest_pct = bar.at("largest_pct");
    return fmt::format("The error of FEM itself is estimated in {} of {} frames{}, which took {:.0f} s. ",
                       bar.at("frames").get<int>(), bar.at("of").get<int>(),
                       largest_pct.is_null() ? "" : fmt::format(", at most {:.2g} %", largest_pct.get<double>()),
                       bar.at("seconds").get<double>());
}

// The distance over the skin also counts points away from the joints, where flesh should move rigidly.
std::string otherwise_at_joints(const nlohmann::json& nearest, double removed_pct)
{
    std::map<std::string, double> medians;
    if (!nearest.is_null() && nearest.at("place") == "joints")
        for (const nlohmann::json& method : nearest.at("methods"))
            medians[method.at("deformer")] = method.at("median_pct");
    if (medians.count("pbs") == 0 || medians.count("lbs") == 0) return "";
    const double nearer_by = medians.at("lbs") - medians.at("pbs");
    if (nearer_by * removed_pct >= 0.0) return "";
    return fmt::format(", although PBS is {} than LBS at the joints", nearer_by > 0.0 ? "nearer" : "farther");
}

std::string skin_words(const nlohmann::json& skin, const nlohmann::json& nearest)
{
    const std::string distance = "the distance of LBS from elastic flesh";
    const double removed_pct = std::round(skin.at("removed_pct").get<double>());
    const std::string change = removed_pct > 0.0   ? fmt::format("removes {:.0f} % of {}", removed_pct, distance)
                               : removed_pct < 0.0 ? fmt::format("adds {:.0f} % to {}", -removed_pct, distance)
                                                   : "changes " + distance + " by less than 1 %";
    return fmt::format("{} (FEM; {} mm instead of {} mm over the skin of a body of 1.7 m{})", change,
                       two_digits(skin.at("pbs_mm")), two_digits(skin.at("lbs_mm")),
                       otherwise_at_joints(nearest, removed_pct));
}

// Where joints move apart, the artist changes the volume.
bool judges_volume(const nlohmann::json& facts)
{
    return !facts.at("motion").contains("stretched_bones");
}

// States what PBS changes on this model, by how much, at what cost, and in which frame it is seen best.
std::string decisive_sentence(const nlohmann::json& facts)
{
    const nlohmann::json &volume = facts.at("volume"), &skin = facts.at("skin"), &widest = facts.at("widest_frame");
    std::vector<std::string> parts;
    if (judges_volume(facts))
        parts.push_back(fmt::format("changes the volume {}, where LBS changes it {}", volume_range(volume.at("pbs")),
                                    volume_range(volume.at("lbs"))));
    const bool is_excluded = facts.at("inverting").value("pbs", nlohmann::json::object()).value("is_excluded", false);
    if (!skin.is_null() && !is_excluded && facts.at("doubtful_reference").is_null())
        parts.push_back(skin_words(skin, facts.at("nearest")));
    parts.push_back(fmt::format("{}takes {} per frame instead of {}", parts.empty() ? "" : "and ",
                                time_of("pbs", facts), time_of("lbs", facts)));
    std::string text = fmt::format(
        "On {}, PBS {}", std::filesystem::path(facts.at("model").at("file").get<std::string>()).filename().string(),
        fmt::join(parts, ", "));
    if (skin.is_null() && facts.at("nearest").is_null() && !facts.at("frame_ms").contains("nh_p1"))
        text += "; which of the two is closer to elastic flesh was not measured";
    return text +
           (widest.is_null() ? "." : fmt::format("; look at frame {}, where the two differ most.", widest.get<int>()));
}

std::string distance_words(const nlohmann::json& distance, const char* where)
{
    if (distance.is_null()) return fmt::format("No frame {} the trained range was held out.", where);
    return fmt::format(
        "In the {} held-out frames {} the trained range, the skin is {:.2g} mm from the reference; with LBS it is "
        "{:.2g} mm.",
        distance.at("frames").get<int>(), where, distance.at("correctives_mm").get<double>(),
        distance.at("lbs_mm").get<double>());
}

}  // namespace

std::string bake_sentence(const nlohmann::json& correctives, const std::string& folder)
{
    return fmt::format(
        "Correctives were learned from {} poses in {:.0f} s. {} {} {}/frames/correctives.glb plays them in "
        "other programs, and {}/frames/correctives.toml is for scenes (`pbskin explain correctives`).",
        correctives.at("trained").get<int>(), correctives.at("seconds").get<double>(),
        distance_words(correctives.at("within"), "within"), distance_words(correctives.at("beyond"), "outside"), folder,
        folder);
}

std::string nearest_sentence(const nlohmann::json& facts)
{
    if (!facts.at("deforms").get<bool>()) return "";
    const std::string inverted = inverting_words(facts.at("inverting"));
    if (!facts.at("doubtful_reference").is_null()) return doubt_words(facts) + inverted;
    return (facts.at("nearest").is_null() ? "" : ranking_words(facts.at("nearest"))) + inverted;
}

std::string trial_sentence(const nlohmann::json& facts)
{
    const nlohmann::json &volume = facts.at("volume"), &joints = facts.at("joints"), &bar = facts.at("error_bar");
    if (!volume.contains("pbs") || !volume.contains("lbs")) return "PBS or LBS broke down in every frame.";
    if (!facts.at("deforms").get<bool>())
        return "No flesh deforms: it rests or moves rigidly in every frame, so that there is nothing to compare.";
    return nearest_sentence(facts) + (joints.is_null() || !judges_volume(facts) ? "" : joint_words(joints)) +
           (bar.is_null() ? "" : error_bar_words(bar)) + decisive_sentence(facts);
}

}  // namespace experiments
