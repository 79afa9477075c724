#include "pbs/character/text_file.hpp"

#include "pbs/geometry/input_error.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace pbs {

std::string read_text_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) throw InputError(path, 0, "", "", "cannot be opened");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace pbs
