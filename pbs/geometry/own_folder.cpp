#include "pbs/geometry/own_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace pbs {
namespace {

namespace fs = std::filesystem;

bool lies_below(const fs::path& file, const fs::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

bool may_be_opened_for(const std::string& path, const std::string& file)
{
    std::error_code code;
    const fs::path target = fs::canonical(file, code);  // links followed
    if (code || !fs::is_regular_file(target, code)) return false;
    const fs::path own = fs::canonical(path, code), named = fs::weakly_canonical(fs::absolute(path).parent_path(), code);
    return target == own || lies_below(target, own.parent_path()) || lies_below(target, named);
}

}  // namespace pbs
