#include "experiments/run/earlier_results.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/terminal.hpp"

#include <fmt/format.h>

#include <exception>
#include <regex>
#include <system_error>
#include <vector>

namespace experiments {

namespace fs = std::filesystem;

bool is_own_frame(const fs::path& file)
{
    static const std::regex own("[A-Za-z0-9_]+_[0-9]{6}\\.vt[up]|[A-Za-z0-9_]+\\.(pvd|glb)");
    return std::regex_match(file.filename().string(), own);
}

namespace {

constexpr const char* aside = ".earlier";

// What a run has written into a folder, relative to it.
std::vector<fs::path> results_in(const fs::path& folder)
{
    std::vector<fs::path> results;
    for (const char* file : {"run.json", "metrics.csv", "frame_statistics.csv", "distances.csv", "iterations.csv", "regions.csv",
                             "bones.csv", "bones_rest.csv", "binding.csv", "surface_rest.vtp", "embedding.csv", "try.json", "report.html"})
        if (fs::exists(fs::symlink_status(folder / file))) results.emplace_back(file);
    for (const char* frames : {"frames", "skin"})
        if (fs::is_directory(folder / frames))
            for (const fs::path& file : analysis::files_in(folder / frames))
                if (is_own_frame(file)) results.push_back(file.lexically_relative(folder));
    return results;
}

void remove_results(const fs::path& folder)
{
    for (const fs::path& file : results_in(folder)) analysis::remove_record(folder / file);
}

void move_results(const fs::path& from, const fs::path& to)
{
    for (const fs::path& file : results_in(from)) {
        fs::create_directories((to / file).parent_path());
        fs::rename(from / file, to / file);
    }
}

// And its folders, unless something else lies in them.
void remove_aside(const fs::path& folder)
{
    remove_results(folder);
    std::error_code not_empty;
    for (const fs::path& emptied : {folder / "frames", folder / "skin", folder}) fs::remove(emptied, not_empty);
}

}  // namespace

EarlierResults::EarlierResults(const fs::path& folder) : folder_(folder)
{
    if (fs::exists(folder_ / "run.json")) {
        remove_aside(folder_ / aside);
        move_results(folder_, folder_ / aside);
    } else {
        remove_results(folder_);
    }
}

EarlierResults::~EarlierResults()
{
    if (path().empty()) return;
    try {
        remove_results(folder_);
        move_results(folder_ / aside, folder_);
        remove_aside(folder_ / aside);
    } catch (const std::exception& error) {
        warn({fmt::format("{}: the earlier results could not be put back: {}", (folder_ / aside).string(), error.what())});
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
