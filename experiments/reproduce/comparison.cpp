#include "experiments/reproduce/comparison.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/studies.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// The tables of a study that have a row per case, whatever other cases there are.
constexpr const char* tables_by_case[] = {"errors.csv", "verification.csv"};
// Frames are kept of those deformers alone that claims select.
constexpr const char* frames_table = "metrics.csv";
// Tables that have a row of every finished run.
constexpr const char* tables_with_rows[] = {"metrics.csv",    "frame_statistics.csv", "bones.csv",
                                            "bones_rest.csv", "binding.csv",          "measurements.csv"};
// Summaries of frames, of which a part has fewer.
constexpr const char* summary_of_frames = "frame_statistics.csv";

std::string study_of(const std::string& name)
{
    return name.substr(0, name.find('/'));
}

// The results before an unfinished run are in a folder whose name begins with a dot.
bool is_shown(const fs::path& folder)
{
    return !folder.filename().string().starts_with('.');
}

// A folder of results with the tables of its finished runs: of one run, of the studies with their plans, or of other
// runs in its folders.
struct Results {
    Results(const std::string& folder, const ComparedFolders& compared)
        : stated(folder),
          opened(folder, compared.studies),
          root(opened.folder()),
          excluded_bodies(compared.excluded_bodies)
    {
        const auto& studies = compared.studies;
        if (!fs::is_directory(root)) throw pbs::InputError(folder, 0, "", "", "expected a folder of results");
        add_runs_of(root);
        if (fs::exists(root / frames_table) && !fs::exists(root / "run.json")) unfinished.insert(".");
        for (const fs::path& study : fs::directory_iterator(root))
            if (is_shown(study) && fs::is_directory(study) &&
                (!studies || std::ranges::count(*studies, study.filename().string()) > 0))
                add_runs_of(study);
        if (runs.empty() && !studies)
            throw pbs::InputError(folder, 0, "", "",
                                  "no results in this folder: expected what `pbskin run` or `pbskin reproduce` writes");
    }

    bool is_kept() const { return root != stated; }

    void add_runs_of(const fs::path& study)
    {
        if (fs::exists(study / "run.json")) return add_run(study);
        if (!has_study_plan(study.string())) {
            if (study == root) return;
            if (fs::exists(study / frames_table)) unfinished.insert(study.lexically_relative(root).string());
            for (const fs::path& run : fs::directory_iterator(study))
                if (is_shown(run) && fs::exists(run / "run.json"))
                    add_run(run);
                else if (fs::exists(run / frames_table))
                    unfinished.insert(run.lexically_relative(root).string());
            return;
        }
        const FinishedRuns finished = finished_runs(study.string());
        for (const std::string& run : finished.folders) add_run(run);
        for (const std::string& run : finished.missing)
            if (fs::exists(study / run / frames_table)) unfinished.insert((study.filename() / run).string());
        // kept records have the tables of studies themselves
        const fs::path in_stated = fs::path(stated) / study.filename();
        for (const char* table : tables_by_case)
            if (fs::exists(in_stated / table)) tables[(study.filename() / table).string()] = in_stated / table;
    }

    void add_run(const fs::path& run)
    {
        const auto is_of_run = [&](const std::string& body) { return is_run_of(run.filename().string(), body); };
        if (std::ranges::any_of(excluded_bodies, is_of_run)) return;
        const fs::path name = run == root ? fs::path() : run.lexically_relative(root);
        runs.insert(name.string());
        for (const fs::path& file : fs::directory_iterator(run))
            if (file.extension() == ".csv") tables[(name / file.filename()).string()] = file;
    }

    fs::path stated;
    OpenedRecords opened;
    fs::path root;
    std::vector<std::string> excluded_bodies;
    std::set<std::string> runs, unfinished;  // with and without run.json
    std::map<std::string, fs::path> tables;
};

// Runs that were ended before they wrote their record. One that the other result has finished is named as a run that is
// missing here.
void name_unfinished_runs(const Results& first, const Results& second, ResultComparison& to)
{
    std::set<std::string> unfinished = first.unfinished;
    unfinished.insert(second.unfinished.begin(), second.unfinished.end());
    for (const std::string& run : unfinished)
        if (const bool is_named = !to.folders.second_is_part && (first.runs.contains(run) || second.runs.contains(run));
            !is_named)
            to.not_compared.push_back(run + ": no run.json: the run was not finished");
}

std::set<std::string> frames_of(const fs::path& run)
{
    std::set<std::string> names;
    if (fs::is_directory(run / "frames"))
        for (const fs::path& file : analysis::files_in(run / "frames"))
            if (file.extension() == ".vtu") names.insert(file.filename().string());
    return names;
}

// Frames that one result has and the other lacks, where both have some.
void name_missing_frames(const Results& first, const Results& second, ResultComparison& to)
{
    for (const std::string& run : first.runs) {
        const std::set<std::string> one = frames_of(first.root / run), other = frames_of(second.root / run);
        if (!second.runs.contains(run) || one.empty() || other.empty()) continue;
        std::vector<std::string> missing;
        std::ranges::set_symmetric_difference(one, other, std::back_inserter(missing));
        for (const std::string& name : missing)
            (one.contains(name) ? to.only_first : to.only_second).push_back((fs::path(run) / "frames" / name).string());
    }
}

// A frame for ParaView ends with its root element.
bool is_cut_off(const fs::path& file)
{
    constexpr std::streamoff most = 64;
    std::ifstream frame(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = frame.tellg();
    frame.seekg(std::max<std::streamoff>(0, size - most));
    return std::string(std::istreambuf_iterator<char>(frame), {}).find("</VTKFile>") == std::string::npos;
}

bool have_other_bytes(const fs::path& one, const fs::path& other)
{
    return fs::exists(other) && (fs::file_size(one) != fs::file_size(other) ||
                                 analysis::read_text(one.string()) != analysis::read_text(other.string()));
}

// The numbers of frames for ParaView are those of the tables. A frame with other bytes than that of the other result
// may be damaged: its arrays are read, whatever their numbers are, for those of an exploded body are no places.
void name_broken_frames(const Results& results, const Results& others, ResultComparison& to)
{
    for (const std::string& run : results.runs)
        for (const std::string& name : frames_of(results.root / run)) {
            const fs::path file = results.root / run / "frames" / name;
            try {
                if (is_cut_off(file))
                    throw pbs::InputError(file.string(), 0, "", "",
                                          "the frame is cut off: expected </VTKFile> at its end");
                if (have_other_bytes(file, others.root / run / "frames" / name)) pbs::read_point_arrays(file.string());
            } catch (const pbs::InputError& error) {
                to.not_compared.push_back(error.what());
            }
        }
}

// Studies that one of two lists of runs lacks altogether are named once.
std::vector<std::string> runs_without(const std::set<std::string>& runs, const std::set<std::string>& other)
{
    std::set<std::string> missing, studies;
    for (const std::string& run : other) studies.insert(study_of(run));
    for (const std::string& run : runs)
        if (!other.contains(run))
            missing.insert(run.empty() ? "." : studies.contains(study_of(run)) ? run : study_of(run));
    return {missing.begin(), missing.end()};
}

// The claims that the frames of a deformer decide.
std::vector<std::string> claims_of_frames(const analysis::CsvTable& frames, int row)
{
    const auto text = [&](const char* column) {
        return frames.has_column(column) ? frames.text_at(row, column) : std::string();
    };
    analysis::CaseKey key{.deformer = text("deformer"),
                          .variant = text("variant"),
                          .order = text("order"),
                          .precision = text("precision")};
    if (frames.has_column("iterations")) key.iterations = frames.number_or_nothing(row, "iterations");
    std::vector<std::string> ids;
    for (const analysis::Claim& claim : claims())
        if (claim.study == "volume" && claim.rule == analysis::ClaimRule::cases && matches(key, claim.own.of))
            ids.push_back(claim.id);
    return ids;
}

// The claims that a measured value is one of the own numbers of.
std::vector<std::string> claims_of_value(const analysis::Measurement& value)
{
    std::vector<std::string> ids;
    for (const analysis::Claim& claim : claims())
        if (std::ranges::count(claim.own.quantities, value.quantity) > 0 && matches(value.of, claim.own.of))
            ids.push_back(claim.id);
    return ids;
}

void count_claims(const fs::path& file, const analysis::CsvTable& table, const analysis::TableComparison& compared,
                  std::map<std::string, ComparedClaim>& claims)
{
    const std::string name = file.filename().string();
    const bool has_frames = name == frames_table, is_printed = name == "printed.csv",
               is_measured = name == "measurements.csv";
    if (!has_frames && !is_printed && !is_measured) return;
    const auto values = is_measured ? analysis::measurements(file.string()) : std::vector<analysis::Measurement>{};
    for (const analysis::ComparedRow& row : compared.rows) {
        std::vector<std::string> ids = has_frames   ? claims_of_frames(table, row.first)
                                       : is_printed ? std::vector{table.text_at(row.first, "claim")}
                                                    : claims_of_value(values[row.first]);
        // a control, or another number on the page of a claim
        if (ids.empty() && is_measured) ids = {values[row.first].claim};
        for (const std::string& id : ids) {
            ComparedClaim& claim = claims[id];
            if (has_frames) {
                ++claim.frames;
                claim.frames_differing += row.differing > 0;
            } else {
                claim.numbers += row.numbers;
                claim.differing += row.differing;
            }
        }
    }
}

void name_rows(const std::string& table, const std::vector<std::string>& rows, std::vector<std::string>& to)
{
    for (const std::string& row : rows) to.push_back(fmt::format("{}: row {}", table, row));
}

void name_columns(const std::string& table, const std::vector<std::string>& columns, std::vector<std::string>& to)
{
    for (const std::string& column : columns) to.push_back(fmt::format("{}: column {}", table, column));
}

// The rows of series that the other table has rows of: a run may have more deformers than its record keeps.
std::vector<std::string> of_known_series(const analysis::TableComparison& compared,
                                         const std::vector<std::string>& rows)
{
    const auto series = [](const std::string& row) { return row.substr(0, row.find(", time_s ")); };
    std::set<std::string> known;
    for (const analysis::ComparedRow& row : compared.rows) known.insert(series(row.settings));
    std::vector<std::string> found;
    std::ranges::copy_if(rows, std::back_inserter(found),
                         [&](const std::string& row) { return known.contains(series(row)); });
    return found;
}

void compare_tables_of(const Results& first, const Results& second, ResultComparison& to)
{
    const bool is_part = to.folders.second_is_part;
    for (const auto& [name, file] : first.tables) {
        const auto same = second.tables.find(name);
        if (same == second.tables.end()) {
            const bool has_run = second.runs.contains(fs::path(name).parent_path().string());
            if (!is_part && has_run) to.only_first.push_back(name);
            continue;
        }
        const std::string table = file.filename().string();
        if (is_part && table == summary_of_frames) continue;
        const analysis::CsvTable one = analysis::read_csv(file.string()),
                                 other = analysis::read_csv(same->second.string());
        // Only values that decide claims are kept with all digits.
        const bool is_exact =
            table == "measurements.csv" || table == "printed.csv" || name.find('/') == name.rfind('/');
        const bool is_rounded = !is_exact && (first.is_kept() || second.is_kept());
        if (std::ranges::count(tables_with_rows, table) > 0 && (one.rows() == 0 || other.rows() == 0))
            to.not_compared.push_back(
                fmt::format("{}: {} has no row", name, one.rows() == 0 ? "that of A" : "that of B"));
        ComparedTable compared{name, analysis::compare_tables(table, one, other, {is_part, is_rounded})};
        count_claims(file, one, compared.rows, to.claims);
        if (!is_part) name_rows(name, compared.rows.only_first, to.only_first);
        const bool has_kept_columns = table == frames_table && (first.is_kept() || second.is_kept());
        if (!is_part) name_columns(name, compared.rows.columns_only_first, to.only_first);
        if (!has_kept_columns) name_columns(name, compared.rows.columns_only_second, to.only_second);
        if (is_part && has_kept_columns)
            compared.rows.only_second = of_known_series(compared.rows, compared.rows.only_second);
        name_rows(name, compared.rows.only_second, to.only_second);
        if (compared.rows.numbers() > 0) to.tables.push_back(std::move(compared));
    }
    if (is_part) return;  // the record lacks long tables
    for (const auto& [name, file] : second.tables)
        if (!first.tables.contains(name) && first.runs.contains(fs::path(name).parent_path().string()))
            to.only_second.push_back(name);
}

std::string value_at(const nlohmann::json& settings, const std::string& path)
{
    const nlohmann::json* at = &settings;
    for (std::size_t begin = 0; begin < path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string key = path.substr(begin, end - begin);
        if (!at->is_object() || !at->contains(key)) return "not stated";
        at = &at->at(key);
        begin = end + 1;
    }
    constexpr std::size_t most = 40;
    const std::string text = at->dump();
    return text.size() > most ? "..." : text;
}

void compare_settings(const Results& first, const Results& second, ResultComparison& to)
{
    for (const std::string& run : first.runs) {
        if (!second.runs.contains(run)) continue;
        const auto settings_in = [&](const Results& results) {
            const std::string file = (results.root / run / "run.json").string();
            const nlohmann::json record = analysis::read_record(file);
            if (!record.is_object()) analysis::refuse_record(file);
            return record.value("scene", record.value("work", nlohmann::json()));
        };
        const nlohmann::json first_settings = settings_in(first), second_settings = settings_in(second);
        if (first_settings.is_null() || second_settings.is_null()) continue;  // kept records have none
        for (const std::string& path : differing_paths(first_settings, second_settings))
            to.other_settings.push_back(fmt::format("{}{}{} = {} | {}", run, run.empty() ? "" : ": ", path,
                                                    value_at(first_settings, path), value_at(second_settings, path)));
    }
}

std::map<std::string, analysis::Verdict> verdicts_in(const Results& results)
{
    std::map<std::string, analysis::Verdict> verdicts;
    for (const Study& study : studies()) {
        const std::string folder = (results.root / study.name).string();
        if (!has_study_plan(folder)) continue;
        const analysis::Records records = read_study_records(folder, results.root.string());
        for (const analysis::Claim& claim : claims())
            if (claim.study == study.name) verdicts.emplace(claim.id, analysis::judge(claim, records));
    }
    return verdicts;
}

// A verdict is compared where both were computed from the same cases and controls.
bool has_the_same_cases(const analysis::Verdict& verdict, const analysis::Verdict& other)
{
    const auto counts = [](const analysis::Verdict& judged) {
        std::vector<std::size_t> sizes = {judged.own.cases.size(), judged.printed.size()};
        for (const analysis::Judged& control : judged.others) sizes.push_back(control.cases.size());
        return sizes;
    };
    return counts(verdict) == counts(other);
}

// The verdicts that kept records state, which have to be those of their tables.
void compare_stated(const Results& results, const std::map<std::string, analysis::Verdict>& verdicts,
                    ResultComparison& to)
{
    const fs::path table = results.stated / "claims.md";
    if (!results.is_kept() || !fs::exists(table)) return;
    const std::string text = analysis::read_text(table.string());
    for (const auto& [id, verdict] : verdicts) {
        const std::size_t line = text.find("\n| " + id + " |");
        const std::string row =
            line == std::string::npos ? "" : text.substr(line + 1, text.find('\n', line + 1) - line - 1);
        if (row.find(fmt::format("| {} |", name_of(verdict.kind))) == std::string::npos)
            to.other_verdicts.push_back(fmt::format("{}: {} states another verdict than {}, which its tables give", id,
                                                    table.string(), name_of(verdict.kind)));
    }
}

void compare_verdicts(const Results& first, const Results& second, ResultComparison& to)
{
    const auto one = verdicts_in(first), other = verdicts_in(second);
    for (const auto& [id, verdict] : one) {
        const auto same = other.find(id);
        if (same == other.end() || same->second.kind == verdict.kind) continue;
        if (to.folders.second_is_part && !has_the_same_cases(verdict, same->second)) continue;
        to.other_verdicts.push_back(fmt::format("{}: {} | {}", id, name_of(verdict.kind), name_of(same->second.kind)));
    }
    compare_stated(first, one, to);
    compare_stated(second, other, to);
}

std::string count_text(int number)
{
    std::string text = std::to_string(number);
    for (int place = static_cast<int>(text.size()) - 3; place > 0; place -= 3)
        text.insert(static_cast<std::size_t>(place), ",");
    return text;
}

void add_list(const std::string& title, const std::vector<std::string>& names, int lines, std::string& text)
{
    if (names.empty()) return;
    text += fmt::format("{} ({}):\n", title, names.size());
    for (std::size_t i = 0; i < names.size() && i < static_cast<std::size_t>(lines); ++i)
        text += "  " + names[i] + "\n";
    if (names.size() > static_cast<std::size_t>(lines))
        text += fmt::format("  and {} more; --json FILE has all\n", names.size() - lines);
}

std::vector<std::string> differences_in(const ResultComparison& compared)
{
    std::vector<std::string> texts;
    for (const ComparedTable& table : compared.tables)
        for (const analysis::CellDifference& difference : table.rows.differing)
            texts.push_back(fmt::format("{}: {}: {} = {} | {}", table.name, difference.row, difference.column,
                                        difference.first, difference.second));
    return texts;
}

}  // namespace

bool is_run_of(const std::string& run, const std::string& body)
{
    return ("_" + run + "_").find("_" + body + "_") != std::string::npos;
}

int ResultComparison::numbers() const
{
    int total = 0;
    for (const ComparedTable& table : tables) total += table.rows.numbers();
    return total;
}

int ResultComparison::equal() const
{
    int total = 0;
    for (const ComparedTable& table : tables) total += table.rows.equal();
    return total;
}

int ResultComparison::differing() const
{
    int total = 0;
    for (const ComparedTable& table : tables) total += static_cast<int>(table.rows.differing.size());
    return total;
}

bool ResultComparison::agrees() const
{
    return differing() == 0 && only_first.empty() && only_second.empty() && other_verdicts.empty() &&
           not_compared.empty();
}

ResultComparison compare_results(const ComparedFolders& folders)
{
    const Results first(folders.first, folders), second(folders.second, folders);
    ResultComparison compared{.folders = folders};
    if (!folders.second_is_part) compared.only_first = runs_without(first.runs, second.runs);
    compared.only_second = runs_without(second.runs, first.runs);
    if (folders.second_is_part)  // no record is kept of some studies
        std::erase_if(compared.only_second, [&](const std::string& name) {
            return has_study_plan((second.root / study_of(name)).string()) &&
                   std::ranges::none_of(first.runs,
                                        [&](const std::string& run) { return study_of(run) == study_of(name); });
        });
    name_unfinished_runs(first, second, compared);
    if (!folders.second_is_part) name_missing_frames(first, second, compared);
    name_broken_frames(first, second, compared);
    name_broken_frames(second, first, compared);
    compare_tables_of(first, second, compared);
    compare_settings(first, second, compared);
    if (folders.excluded_bodies.empty()) compare_verdicts(first, second, compared);
    const bool states_what_differs =
        !folders.second_is_part && !(compared.only_first.empty() && compared.only_second.empty());
    if (!folders.studies && compared.tables.empty() && compared.not_compared.empty() && !states_what_differs)
        throw pbs::InputError(folders.second, 0, "", "", "no number in common with " + folders.first);
    return compared;
}

std::string comparison_text(const ResultComparison& compared, int lines)
{
    const int numbers = compared.numbers(), agreeing = numbers - compared.differing();
    std::string text = fmt::format("{} of {} numbers agree, {} of them in every digit.\n", count_text(agreeing),
                                   count_text(numbers), count_text(compared.equal()));
    add_list("other settings, A | B", compared.other_settings, lines, text);
    add_list("other verdicts, A | B", compared.other_verdicts, lines, text);
    add_list("other numbers, A | B", differences_in(compared), lines, text);
    add_list("only in A = " + compared.folders.first, compared.only_first, lines, text);
    add_list("only in B = " + compared.folders.second, compared.only_second, lines, text);
    add_list("not compared", compared.not_compared, lines, text);
    return text;
}

std::string claim_text(const ComparedClaim& compared)
{
    const bool has_frames = compared.frames > 0;
    const int all = has_frames ? compared.frames : compared.numbers;
    const int differing = has_frames ? compared.frames_differing : compared.differing;
    const char* what = has_frames ? " frames" : "";  // short, for a column of the last screen
    if (differing > 0) return fmt::format("{} of {}{} differ", count_text(differing), count_text(all), what);
    return all > 0 ? fmt::format("{}{} agree", count_text(all), what) : "";
}

std::string repeated_text(const ResultComparison& compared)
{
    const int numbers = compared.numbers();
    if (numbers == 0 && compared.other_verdicts.empty())
        return "The record has none of these runs: nothing was compared.";
    if (compared.agrees())
        return fmt::format("This machine repeats the record: {0} of {0} numbers agree ({1} in every digit).",
                           count_text(numbers), count_text(compared.equal()));
    return fmt::format("This machine does NOT repeat the record: {} of {} numbers differ.",
                       count_text(compared.differing()), count_text(numbers));
}

nlohmann::json to_json(const ResultComparison& compared)
{
    nlohmann::json tables = nlohmann::json::array(), claims = nlohmann::json::object();
    for (const ComparedTable& table : compared.tables) {
        nlohmann::json differing = nlohmann::json::array();
        for (const analysis::CellDifference& difference : table.rows.differing)
            differing.push_back({{"row", difference.row},
                                 {"column", difference.column},
                                 {"first", difference.first},
                                 {"second", difference.second}});
        tables.push_back({{"table", table.name},
                          {"rows", table.rows.rows.size()},
                          {"numbers", table.rows.numbers()},
                          {"equal", table.rows.equal()},
                          {"differing", differing}});
    }
    for (const auto& [id, of] : compared.claims)
        claims[id] = {{"numbers", of.numbers},
                      {"differing", of.differing},
                      {"frames", of.frames},
                      {"frames_differing", of.frames_differing}};
    return {{"schema", 1},
            {"first", compared.folders.first},
            {"second", compared.folders.second},
            {"agrees", compared.agrees()},
            {"numbers", compared.numbers()},
            {"equal", compared.equal()},
            {"tables", tables},
            {"claims", claims},
            {"only_first", compared.only_first},
            {"only_second", compared.only_second},
            {"not_compared", compared.not_compared},
            {"other_settings", compared.other_settings},
            {"other_verdicts", compared.other_verdicts}};
}

std::vector<analysis::CheckSuite> suites_of(const ResultComparison& compared)
{
    std::vector<analysis::CheckSuite> suites;
    const auto add = [&](const std::string& suite, const std::string& name, bool agrees, const std::string& message) {
        if (suites.empty() || suites.back().name != suite) suites.push_back({.name = suite});
        suites.back().cases.push_back({.suite = suite,
                                       .name = name,
                                       .state = agrees ? analysis::CheckState::held : analysis::CheckState::failed,
                                       .message = message});
    };
    for (const ComparedTable& table : compared.tables) {
        const std::size_t count = table.rows.differing.size();
        std::string message =
            fmt::format("{} of {} numbers agree", table.rows.numbers() - static_cast<int>(count), table.rows.numbers());
        if (count > 0) {
            const analysis::CellDifference& difference = table.rows.differing.front();
            message += fmt::format("; the first that differs: {}: {} = {} | {}", difference.row, difference.column,
                                   difference.first, difference.second);
        }
        add(study_of(table.name), table.name, count == 0, message);
    }
    for (const std::string& name : compared.only_first)
        add("only in A", name, false, "only in " + compared.folders.first);
    for (const std::string& name : compared.only_second)
        add("only in B", name, false, "only in " + compared.folders.second);
    for (const std::string& text : compared.not_compared) add("not compared", text, false, text);
    for (const std::string& text : compared.other_verdicts) add("verdicts", study_of(text), false, text);
    return suites;
}

std::string records_folder()
{
    if (const char* folder = std::getenv("PBSKIN_RECORDS"); folder && *folder) return folder;
    return (fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "pbskin" / "records").string();
}

}  // namespace experiments
