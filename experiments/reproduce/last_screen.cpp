#include "experiments/reproduce/last_screen.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/sensitivity.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// 83.5 to 176 1/s; empty without numbers.
std::string range_text(const analysis::Verdict& verdict)
{
    std::vector<double> values;
    std::string unit;
    for (const analysis::JudgedCase& judged_case : verdict.own.cases) {
        if (!std::isfinite(judged_case.value)) continue;
        values.push_back(judged_case.value);
        unit = judged_case.unit;
    }
    if (values.empty()) return "";
    const auto [least, most] = std::ranges::minmax(values);
    return fmt::format("{:.3g} to {:.3g}{}", least, most, unit.empty() || unit == "1" ? "" : " " + unit);
}

// Its own numbers, or without them those on its page, such as the controls.
ComparedClaim compared_claim(const ResultComparison& compared, const analysis::Claim& claim)
{
    for (const std::string& id : {claim.id, page_of(claim)})
        if (const auto found = compared.claims.find(id); found != compared.claims.end()) return found->second;
    return {};
}

// Numbers that agree with the record; for times, which are not compared, the range on this machine.
std::string here_text(const analysis::Verdict& here, const ComparedClaim& compared)
{
    const std::string numbers = claim_text(compared);
    return numbers.empty() ? range_text(here) : numbers;
}

std::map<std::string, std::string> here_texts(const LastScreen& screen, const ResultComparison& compared)
{
    std::map<std::string, std::string> texts;
    for (const analysis::Verdict& verdict : screen.here) {
        const std::string text = here_text(verdict, compared_claim(compared, verdict.claim));
        if (!text.empty()) texts[verdict.claim.id] = text;
    }
    return texts;
}

void write_repeated(const ResultComparison& compared, const std::map<std::string, std::string>& here,
                    const std::string& folder)
{
    nlohmann::json claims = nlohmann::json::object();
    for (const auto& [id, text] : here) {
        const ComparedClaim counted = compared_claim(compared, claim_named(id));
        const int all = counted.frames > 0 ? counted.frames : counted.numbers,
                  differing = counted.frames > 0 ? counted.frames_differing : counted.differing;
        claims[id] = {{"compared", all}, {"agree", all - differing}, {"text", text}};
    }
    nlohmann::json repeated = to_json(compared);
    repeated["claims"] = claims;
    repeated["text"] = repeated_text(compared);
    repeated.erase("second");  // the folder of this file, which may be moved
    analysis::write_text_atomically(analysis::path_in(folder, "repeated.json"), repeated.dump(1) + "\n");
}

// The record's verdicts on the claims of these studies. A study that the record lacks is judged by the results.
std::vector<analysis::Verdict> on_record(const LastScreen& screen, const std::string& records)
{
    std::vector<std::string> studies;
    for (const analysis::Verdict& verdict : screen.here) studies.push_back(verdict.claim.study);
    const OpenedRecords opened(records, studies);
    std::map<std::string, analysis::Records> of_studies;
    std::vector<analysis::Verdict> verdicts = screen.here;
    for (analysis::Verdict& verdict : verdicts) {
        const std::string &study = verdict.claim.study, folder = (fs::path(opened.folder()) / study).string();
        if (!has_study_plan(folder)) continue;
        if (!of_studies.contains(study)) of_studies[study] = read_study_records(folder, opened.folder());
        verdict = analysis::judge(verdict.claim, of_studies[study]);
        verdict.sensitivity = analysis::sensitivity(verdict.claim, of_studies[study]);
    }
    return verdicts;
}

// A method within a time per frame, where material and springs of each reference variant are known.
struct Method {
    std::string name;
    bool is_own = false, is_within = false;  // of the user's own; within the time on this machine
    double budget_ms = 0.0, ms = 0.0, share_pct = 0.0, low_pct = 0.0, high_pct = 0.0, skin_mm = 0.0;
    long long poses = 0;
};

std::vector<Method> compared_methods(const std::string& records)
{
    std::vector<Method> found;
    const std::string file = (fs::path(records) / "work_precision" / "methods.csv").string();
    if (!fs::exists(file)) return found;
    const analysis::CsvTable table = analysis::read_csv(file);
    for (int row = 0; row < table.rows(); ++row)
        if (const std::string name = table.text_at(row, "method"); table.text_at(row, "table") == "known")
            found.push_back({.name = name,
                             .is_own = table.text_at(row, "setting").empty() && !find_deformer_kind(name),
                             .is_within = table.text_at(row, "within") != "no",
                             .budget_ms = table.number(row, "budget_ms"),
                             .ms = table.number_or_nothing(row, "ms").value_or(0.0),
                             .share_pct = 100.0 * table.number(row, "share"),
                             .low_pct = 100.0 * table.number(row, "share_low"),
                             .high_pct = 100.0 * table.number(row, "share_high"),
                             .skin_mm = table.number_or_nothing(row, "skin_mm").value_or(0.0),
                             .poses = table.integer(row, "poses")});
    return found;
}

std::string title_of(const std::string& method)
{
    static const std::map<std::string, std::string> titles = {{"lbs", "LBS"},
                                                              {"dqs", "DQS"},
                                                              {"pbs", "PBS"},
                                                              {"delta_mush", "delta mush"},
                                                              {"quasi_newton", "quasi-Newton"},
                                                              {"vbd", "vertex block descent"},
                                                              {"warped_newton", "warped Newton"},
                                                              {"correctives", "LBS with correctives"},
                                                              {"xpbd_neo_hookean", "neo-Hookean XPBD"},
                                                              {"xpbd", "XPBD"}};
    const auto found = titles.find(method);
    return found == titles.end() ? method : found->second;
}

// How far LBS and PBS are from flesh, and which method is nearest within 1 ms, by the record of work_precision. Empty
// without one.
std::string answers_text(const std::string& records)
{
    std::vector<Method> methods = compared_methods(records);
    std::erase_if(methods, [](const Method& method) { return method.budget_ms != 1.0 || !method.is_within; });
    const auto find_method = [&](const std::string& name) { return std::ranges::find(methods, name, &Method::name); };
    const auto best = std::ranges::min_element(methods, {}, &Method::share_pct), lbs = find_method("lbs"),
               pbs = find_method("pbs"), mush = find_method("delta_mush");
    if (lbs == methods.end() || pbs == methods.end() || mush == methods.end()) return "";
    return fmt::format(
        "Distance from flesh: the skin of a body of 1.7 m is {:.2g} mm away with LBS, {:.2g} mm with PBS ({} poses).\n"
        "1 ms per frame: {} leaves {:.0f} % of LBS's error if the material is known, PBS {:.0f} %, delta mush {:.0f} "
        "%.\n",
        lbs->skin_mm, pbs->skin_mm, pbs->poses, title_of(best->name), best->share_pct, pbs->share_pct, mush->share_pct);
}

// "0.1 to 10 ms": the times of the tables that are shorter than the time of a method. Empty: it has a row at each of
// them.
std::string too_slow_text(std::vector<double> shorter_ms, double ms)
{
    std::erase_if(shorter_ms, [&](double time_ms) { return time_ms >= ms; });
    if (shorter_ms.empty()) return "";
    const std::string first = shorter_ms.size() > 1 ? fmt::format("{:g} to ", shorter_ms.front()) : "";
    return fmt::format("; too slow for {}{:g} ms", first, shorter_ms.back());
}

// One line for each deformer of the user's own, at the shortest time that it keeps, with familiar methods at that time.
std::string own_methods_text(const std::string& results)
{
    const std::vector<Method> methods = compared_methods(results);
    std::set<double> times_ms;
    for (const Method& method : methods)
        if (std::isfinite(method.budget_ms)) times_ms.insert(method.budget_ms);
    std::map<std::string, Method> own;  // methods.csv has the shortest time first
    for (const Method& method : methods)
        if (method.is_own) own.try_emplace(method.name, method);
    std::string text;
    for (const auto& [name, method] : own) {
        text += fmt::format("{}: {:.3g} ms per frame, {:.0f} % of LBS's error [{:.0f}, {:.0f}] in {} poses", name,
                            method.ms, method.share_pct, method.low_pct, method.high_pct, method.poses);
        std::vector<std::string> shares;
        for (const char* familiar : {"dqs", "delta_mush", "pbs"})
            for (const Method& other : methods)
                if (other.name == familiar && other.budget_ms == method.budget_ms)
                    shares.push_back(fmt::format("{} {:.0f} %", title_of(familiar), other.share_pct));
        if (!shares.empty() && !times_ms.empty())
            text += fmt::format("; with at most {:g} ms: {}", std::min(method.budget_ms, *times_ms.rbegin()),
                                fmt::join(shares, ", "));
        text += too_slow_text({times_ms.begin(), times_ms.end()}, method.ms) + ".\n";
    }
    return text;
}

}  // namespace

void write_verdicts(const std::vector<analysis::Verdict>& verdicts, const std::string& folder)
{
    analysis::write_text_atomically(
        analysis::path_in(folder, "claims.json"),
        analysis::claims_json(verdicts, analysis::collect_provenance(1).git_revision).dump(2) + "\n");
    analysis::write_text_atomically(analysis::path_in(folder, "claims.md"), analysis::claims_markdown(verdicts));
}

bool show_last_screen(LastScreen screen)
{
    std::ranges::stable_sort(screen.here, {}, [](const analysis::Verdict& verdict) { return verdict.claim.id; });
    const std::string records = records_folder();
    const std::size_t width = std::min<std::size_t>(terminal_width(), 100);
    const bool has_record = fs::exists(fs::path(records) / "provenance.json");
    if (const char* folder = std::getenv("PBSKIN_RECORDS"); folder && *folder && !has_record)
        throw pbs::InputError("", 0, "PBSKIN_RECORDS", folder, "expected a folder of kept records");
    if (!has_record) {
        fmt::print("There is no kept record at {}: nothing was compared.\n", records);
        write_verdicts(screen.here, screen.folder);
        fmt::print("{}{}", analysis::claims_table(screen.here, width, terminal_has_colours()),
                   own_methods_text(screen.folder));
        return true;
    }
    const ResultComparison compared = compare_results({.first = records,
                                                       .second = screen.folder,
                                                       .second_is_part = true,
                                                       .studies = screen.studies,
                                                       .excluded_bodies = screen.other_tets});
    const std::map<std::string, std::string> here = here_texts(screen, compared);
    const std::vector<analysis::Verdict> verdicts = screen.full ? screen.here : on_record(screen, records);
    write_verdicts(verdicts, screen.folder);
    write_repeated(compared, here, screen.folder);
    fmt::print("{}\n", repeated_text(compared));
    if (!compared.agrees()) fmt::print("{}", comparison_text(compared));
    const analysis::FurtherColumn repeated{.heading = "here", .texts = here};
    for (const analysis::Verdict& verdict : screen.here)
        if (verdict.kind == analysis::VerdictKind::not_computable)
            fmt::print("{} cannot be computed here: no record of {}\n", verdict.claim.id,
                       fmt::join(verdict.missing, ", "));
    if (!verdicts.empty())
        fmt::print("\n{}", analysis::claims_table(verdicts, width, terminal_has_colours(), repeated));
    const std::string own = own_methods_text(screen.folder);
    fmt::print("{}", own.empty() ? answers_text(records) : own);
    return compared.agrees();
}

}  // namespace experiments
