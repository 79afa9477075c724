#include "experiments/reproduce/reproduce.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/json_file.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/run/broken_frames.hpp"
#include "experiments/run/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

namespace experiments {
namespace {

namespace fs = std::filesystem;

std::string plan_file(const std::string& folder)
{
    return (fs::path(folder) / "plan.json").string();
}

// The names of studies and runs become folders below the records.
void require_below(const std::string& name, const std::string& file)
{
    const fs::path path = name;
    if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
        throw pbs::InputError(file, 0, "name", name, "expected no leading / and no .. in a name");
}

// The entries of plan.json are checked, for the file may have been changed.
const nlohmann::json& list_in(const pbs::JsonFile& plan, const std::string& key)
{
    const nlohmann::json& value = plan.at(key);
    if (!value.is_array()) plan.refuse(key, "expected a list, as reproduce writes it");
    return value;
}

std::string text_in(const pbs::JsonFile& plan, const nlohmann::json& part, const std::string& key)
{
    const nlohmann::json& value = plan.at(part, key);
    if (!value.is_string()) plan.refuse(key, "expected a text");
    return value;
}

// The body and the motion of a run of a scene.
analysis::CaseKey key_of(const StudyRun& run)
{
    const MotionSpec& motion = run.scene.motion;
    analysis::CaseKey key = {.body = run.scene.character.body, .motion = run.motion, .joint = motion.joint};
    if (!motion.clip.empty()) key.motion = fs::path(motion.clip).stem().string();
    if (!motion.movements.empty()) key.motion = "range_of_motion";
    if (motion.movements.size() == 1) key.pose = motion.movements.front();
    if (key.motion.empty())
        throw std::logic_error("run " + run.name + ": a sweep needs a name, the key motion of its case");
    if (run.scene.character.vertices > 0) key.vertices = run.scene.character.vertices;
    return key;
}

// Reads the values of one run. A recorded value that follows from others is replaced by the one that is concluded now.
std::vector<analysis::Measurement> measurements_of(const fs::path& study, const std::string& csv)
{
    std::vector<analysis::Measurement> measured = analysis::measurements(csv);
    const auto known = std::ranges::find(studies(), study.filename().string(), &Study::name);
    if (known == studies().end() || !known->conclusions) return measured;
    const std::vector<analysis::Measurement> concluded = known->conclusions(measured);
    for (analysis::Measurement& recorded : measured)
        if (const auto* now = analysis::find_measurement(concluded, recorded.quantity, recorded.of)) recorded = *now;
    return measured;
}

void add_run(analysis::Records& records, const fs::path& folder, const std::string& name,
             const analysis::CaseKey& place, bool beside)
{
    if (const fs::path printed = folder / "printed.csv"; fs::exists(printed))
        for (auto& value : analysis::printed_values(printed.string())) records.printed.push_back(std::move(value));
    if (const fs::path measured = folder / "measurements.csv"; fs::exists(measured))
        for (auto& measurement : measurements_of(folder.parent_path(), measured.string())) {
            measurement.run = name;
            records.measurements.push_back(std::move(measurement));
        }
    if (const fs::path metrics = folder / "metrics.csv"; fs::exists(metrics))
        for (auto& record : analysis::case_records(analysis::read_csv(metrics.string()), name)) {
            record.beside = beside;
            record.place = place;
            records.cases.push_back(std::move(record));
        }
}

// Writes a file of the temporary folder, which need not survive a crash.
void write_scratch(const fs::path& file, const std::string& text)
{
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw pbs::InputError(file.string(), 0, "", "", "cannot be written");
}

// The first column of a table names the run of each row. A row without further cells states that the run's table has no
// rows.
void write_tables_of_runs(const fs::path& merged, const fs::path& study)
{
    const analysis::CsvTable rows = analysis::parse_csv(kept_text(merged.string()), merged.string());
    const std::string& run_column = rows.columns().front();
    const std::vector<std::string> columns(rows.columns().begin() + 1, rows.columns().end());
    std::map<std::string, analysis::CsvTable> tables;
    for (int row = 0; row < rows.rows(); ++row) {
        analysis::CsvTable& table = tables.try_emplace(rows.text_at(row, run_column), columns).first->second;
        std::vector<analysis::CsvTable::Cell> cells;
        for (const std::string& column : columns) cells.emplace_back(rows.text_at(row, column));
        if (std::ranges::any_of(cells, [](const auto& cell) { return !cell.text.empty(); })) table.add_row(cells);
    }
    const fs::path name = merged.extension() == ".gz" ? merged.stem() : merged.filename();
    for (const auto& [run, table] : tables) {
        require_below(run, merged.string());
        fs::create_directories(study / run);
        write_scratch(study / run / name, table.text());
    }
}

using nlohmann::json;

// "3 inverted, 1 not converged"
std::string kinds_of(const std::vector<BrokenFrame>& broken)
{
    std::map<std::string, int> counts;
    for (const BrokenFrame& frame : broken) ++counts[what_of(frame)];
    std::vector<std::string> kinds;
    for (const auto& [what, count] : counts) kinds.push_back(fmt::format("{} {}", count, what));
    return fmt::format("{}", fmt::join(kinds, ", "));
}

std::string broken_line(const json& of_deformer, int frames)
{
    const auto broken = of_deformer.get<std::vector<BrokenFrame>>();
    return fmt::format("broke down in {} of {} frames ({}), the first {}", broken.size(), frames, kinds_of(broken),
                       text_of(of_deformer.at(0).get<BrokenFrame>()));
}

std::string marks_of(const json& outcome, const std::string& run)
{
    std::string lines;
    const json none = json::object(), below = outcome.value("frames_below_reference_error", none),
               broken = outcome.value("broken_frames", none);
    if (const int count = outcome.value("frames_with_overlap", 0); count > 0)
        lines += fmt::format("     {}: the reference overlaps itself in {} of {} frames\n", run, count,
                             outcome.at("frames").get<int>());
    if (const double share_pct = outcome.value("largest_masked_share_pct", 0.0); share_pct > 0.0)
        lines += fmt::format("     {}: errors leave out up to {:.2g} % of the volume, at the tips of creases\n", run,
                             share_pct);
    for (const auto& [label, count] : below.items())
        lines +=
            fmt::format("     {}: the error of {} at the joints is not above the reference's own in {} of {} frames\n",
                        run, label, count.get<int>(), outcome.at("frames").get<int>());
    for (const auto& [label, frames] : broken.items())
        lines += fmt::format("     {}: {} {}\n", run, label, broken_line(frames, outcome.at("frames").get<int>()));
    return lines;
}

}  // namespace

std::string kept_text(const std::string& file)
{
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> opened(gzopen(file.c_str(), "rb"), gzclose);
    if (!opened) throw pbs::InputError(file, 0, "", "", "cannot be read");
    std::string text;
    std::array<char, 1 << 16> block;
    int count = 0;
    while ((count = gzread(opened.get(), block.data(), block.size())) > 0)
        text.append(block.data(), static_cast<std::size_t>(count));
    int code = Z_OK;
    gzerror(opened.get(), &code);
    if (count < 0 || code != Z_OK) throw pbs::InputError(file, 0, "", "", "expected a whole gzip file");
    return text;
}

OpenedRecords::OpenedRecords(const std::string& folder, const std::optional<std::vector<std::string>>& studies)
    : folder_(folder)
{
    const auto is_needed = [&](const std::string& name) {  // STUDY, or STUDY/RUN
        return !studies || std::ranges::count(*studies, name.substr(0, name.find('/'))) > 0;
    };
    const std::string provenance = analysis::path_in(folder, "provenance.json"),
                      all_plans = analysis::path_in(folder, "plans.json");
    if (!fs::exists(provenance)) return;
    const fs::path opened = scratch_.emplace().path();
    analysis::from_record(all_plans, [&](const nlohmann::json& plans) {
        for (const auto& [study, plan] : plans.items()) {
            require_below(study, all_plans);
            if (!is_needed(study)) continue;
            fs::create_directories(opened / study);
            write_scratch(plan_file((opened / study).string()), plan.dump());
            if (const fs::path merged = fs::path(folder) / study / "runs"; fs::is_directory(merged))
                for (const fs::path& table : fs::directory_iterator(merged))
                    write_tables_of_runs(table, opened / study);
        }
    });
    analysis::from_record(provenance, [&](const nlohmann::json& record) {
        for (const nlohmann::json& origin : record.at("origins"))
            for (const std::string run : origin.at("runs")) {
                require_below(run, provenance);
                if (!is_needed(run)) continue;
                fs::create_directories(opened / run);
                write_scratch(opened / run / "run.json", nlohmann::json{{"schema", origin.at("schema")}}.dump());
            }
    });
    folder_ = opened.string();
}

void write_study_plan(const std::string& folder, const StudyPlan& plan)
{
    auto runs = nlohmann::json::array(), left_out = nlohmann::json::array();
    for (const StudyRun& run : plan.runs) {
        nlohmann::json entry = {{"name", run.name}, {"cost_s", run.cost_s}};
        if (!run.work) {
            entry["scene"] = run.scene.name;
            entry["of"] = to_json_of(key_of(run));
        }
        if (run.beside) entry["beside"] = true;
        runs.push_back(entry);
    }
    for (const analysis::LeftOut& out : plan.left_out)
        left_out.push_back({{"scene", out.scene}, {"reason", out.reason}});
    const char* extent = plan.extent == Extent::full ? "full" : "quick";
    fs::create_directories(folder);
    analysis::write_text_atomically(
        plan_file(folder),
        nlohmann::json{{"schema", 1}, {"extent", extent}, {"runs", runs}, {"left_out", left_out}}.dump(2) + "\n");
}

bool has_study_plan(const std::string& folder)
{
    return fs::exists(plan_file(folder));
}

FinishedRuns finished_runs(const std::string& folder)
{
    FinishedRuns finished{.folder = folder};
    const pbs::JsonFile plan(plan_file(folder));
    for (const auto& run : list_in(plan, "runs")) {
        const std::string name = text_in(plan, run, "name");
        const fs::path of_run = fs::path(folder) / name;
        if (fs::exists(of_run / "run.json"))
            finished.folders.push_back(of_run.string());
        else
            finished.missing.push_back(name);
    }
    return finished;
}

analysis::Records read_study_records(const std::string& folder, const std::string& root)
{
    analysis::Records records;
    const pbs::JsonFile plan(plan_file(folder));
    for (const auto& out : list_in(plan, "left_out"))
        records.left_out.push_back({text_in(plan, out, "scene"), text_in(plan, out, "reason")});
    for (const auto& run : list_in(plan, "runs"))
        if (run.contains("scene")) records.planned_scenes.push_back(text_in(plan, run, "scene"));
    for (const auto& out : records.left_out) records.planned_scenes.push_back(out.scene);
    for (const auto& run : list_in(plan, "runs")) {
        const std::string name = text_in(plan, run, "name");
        const fs::path of_run = fs::path(folder) / name;
        const std::string record = (of_run / "run.json").string();
        if (!fs::exists(record)) {
            records.missing_runs.push_back(name);
            continue;
        }
        const nlohmann::json schema = pbs::JsonFile(record).at("schema");
        if (schema != run_schema)
            throw pbs::InputError(record, 0, "schema", schema.dump(), fmt::format("expected {}", run_schema));
        // Body and motion of the run, as write_study_plan() writes them for scenes; empty if the plan has none.
        const auto place =
            run.contains("of") ? analysis::case_key(run.at("of"), plan_file(folder)) : analysis::CaseKey{};
        const nlohmann::json beside = run.value("beside", nlohmann::json(false));
        if (!beside.is_boolean()) plan.refuse("beside", "expected true or false");
        add_run(records, of_run, of_run.lexically_relative(root).string(), place, beside);
    }
    return records;
}

std::string marked_frames(const std::vector<std::string>& folders)
{
    std::string lines;
    for (const std::string& folder : folders)
        lines += analysis::from_record((fs::path(folder) / "run.json").string(), [&](const json& run) {
            return marks_of(run.at("outcome"), fs::path(folder).filename().string());
        });
    return lines;
}

}  // namespace experiments
