#include "pbs/geometry/named_link.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace pbs {

namespace fs = std::filesystem;

NamedLink::NamedLink(const std::string& path, const std::string& extension) : link_(path)
{
    if (lower_extension(path) == extension) return;
    std::error_code code;
    const fs::path target = fs::canonical(path, code);
    std::string made = (fs::temp_directory_path(code) / "pbskin-XXXXXX").string();
    if (!code && mkdtemp(made.data())) {
        folder_ = made;
        link_ = (fs::path(folder_) / (fs::path(path).filename().string() + extension)).string();
        fs::create_symlink(target, link_, code);
        if (!code) return;
    }
    fs::remove_all(folder_, code);
    throw InputError(path, 0, "extension", lower_extension(path), "no link of another name can be made: rename the file to " + extension);
}

NamedLink::~NamedLink()
{
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

}  // namespace pbs
