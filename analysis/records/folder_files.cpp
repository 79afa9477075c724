#include "analysis/records/folder_files.hpp"

#include "pbs/geometry/input_error.hpp"

namespace analysis {
namespace {

namespace fs = std::filesystem;

void require(const std::error_code& error, const fs::path& path, const char* what)
{
    if (error) throw pbs::InputError(path.string(), 0, "", "", what + error.message());
}

}  // namespace

void remove_record(const fs::path& file)
{
    std::error_code error;
    fs::remove(file, error);
    require(error, file, "an earlier run's record cannot be removed: ");
}

std::string path_in(const std::string& folder, const std::string& name)
{
    return (fs::path(folder) / name).string();
}

std::vector<fs::path> files_in(const fs::path& folder)
{
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) files.push_back(entry->path());
    require(error, folder, "the folder cannot be read: ");
    return files;
}

}  // namespace analysis
