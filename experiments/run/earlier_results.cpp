#include "experiments/run/earlier_results.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/terminal.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <regex>
#include <system_error>
#include <vector>

namespace experiments {

using nlohmann::literals::operator""_json_pointer;

namespace fs = std::filesystem;

bool is_own_frame(const fs::path& file)
{
    static const std::regex own("[A-Za-z0-9_]+_[0-9]{6}\\.vt[up]|[A-Za-z0-9_]+\\.(pvd|glb)");
    return std::regex_match(file.filename().string(), own);
}

namespace {

constexpr const char* aside = ".earlier";

// The files that a run has written into a folder, relative to the folder. run.json is the last one.
std::vector<fs::path> results_in(const fs::path& folder)
{
    std::vector<fs::path> results;
    for (const char* frames : {"frames", "skin"})
        if (fs::is_directory(folder / frames))
            for (const fs::path& file : analysis::files_in(folder / frames))
                if (is_own_frame(file)) results.push_back(file.lexically_relative(folder));
    for (const char* file :
         {"metrics.csv", "frame_statistics.csv", "distances.csv", "iterations.csv", "regions.csv", "bones.csv",
          "bones_rest.csv", "binding.csv", "surface_rest.vtp", "embedding.csv", "try.json", "report.html", "run.json"})
        if (fs::exists(fs::symlink_status(folder / file))) results.emplace_back(file);
    return results;
}

void remove_results(const fs::path& folder)
{
    for (const fs::path& file : results_in(folder)) analysis::remove_record(folder / file);
}

// A kill may end the program between two files. run.json is moved aside last and put back first, so that the next run
// finds out from its place that files are still to be put back.
enum class Record { first, last };
void move_results(const fs::path& from, const fs::path& to, Record record)
{
    std::vector<fs::path> results = results_in(from);
    if (record == Record::first) std::ranges::reverse(results);
    for (const fs::path& file : results) fs::create_directories((to / file).parent_path());
    for (const fs::path& file : results) fs::rename(from / file, to / file);
}

// The folder of the earlier results goes with them, unless something else lies in it.
void remove_aside(const fs::path& folder)
{
    remove_results(folder);
    std::error_code not_empty;
    for (const fs::path& emptied : {folder / "frames", folder / "skin", folder}) fs::remove(emptied, not_empty);
}

// Whether the folder has the results of a run that was not interrupted.
bool has_finished_run(const fs::path& folder)
{
    const fs::path record = folder / "run.json";
    if (!fs::exists(record)) return false;
    const nlohmann::json run = nlohmann::json::parse(analysis::read_text(record.string()), nullptr, false);
    return !(run.is_object() && run.value("/outcome/interrupted"_json_pointer, false));
}

}  // namespace

EarlierResults::EarlierResults(const fs::path& folder) : folder_(folder)
{
    const fs::path earlier = folder_ / aside;
    // a run was killed while it moved them
    if (!fs::exists(earlier / "run.json")) move_results(earlier, folder_, Record::last);
    const bool has_earlier = fs::exists(earlier / "run.json");
    if (has_earlier ? has_finished_run(folder_) : fs::exists(folder_ / "run.json")) {
        remove_aside(earlier);
        try {
            move_results(folder_, earlier, Record::last);
        } catch (...) {
            put_back();
            throw;
        }
    } else {
        remove_results(folder_);
    }
}

void EarlierResults::put_back()
{
    try {
        move_results(folder_ / aside, folder_, Record::first);
        remove_aside(folder_ / aside);
    } catch (const std::exception& error) {
        warn({fmt::format("{}: the earlier results could not be put back: {}", (folder_ / aside).string(),
                          error.what())});
    }
}

EarlierResults::~EarlierResults()
{
    if (path().empty()) return;
    try {
        remove_results(folder_);
        put_back();
    } catch (const std::exception& error) {
        warn({error.what()});
    }
}

std::string EarlierResults::path() const
{
    std::error_code unreadable;
    return !is_settled_ && fs::exists(folder_ / aside / "run.json", unreadable) ? (folder_ / aside).string() : "";
}

void EarlierResults::replace()
{
    is_settled_ = true;
    remove_aside(folder_ / aside);
}

void EarlierResults::keep_aside()
{
    is_settled_ = true;
}

}  // namespace experiments
