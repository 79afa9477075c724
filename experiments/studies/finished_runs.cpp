#include "experiments/studies/finished_runs.hpp"

#include "analysis/records/record_files.hpp"

#include <filesystem>

namespace experiments {

namespace fs = std::filesystem;

std::vector<std::string> FinishedRuns::files(const std::string& file) const
{
    std::vector<std::string> paths;
    for (const std::string& run : folders)
        if (const fs::path path = fs::path(run) / file; fs::exists(path)) paths.push_back(path.string());
    return paths;
}

analysis::CsvTable FinishedRuns::gathered(const std::string& file) const
{
    analysis::CsvTable all{{}};
    for (const std::string& path : files(file)) all.append(analysis::read_csv(path));
    return all;
}

void FinishedRuns::write(const std::string& file, const std::string& text) const
{
    analysis::write_text_atomically((fs::path(folder) / file).string(), text);
}

void FinishedRuns::write(const std::string& file, const analysis::CsvTable& table) const
{
    table.write((fs::path(folder) / file).string());
}

}  // namespace experiments
