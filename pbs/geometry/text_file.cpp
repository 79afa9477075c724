#include "pbs/character/text_file.hpp"

#include "pbs/geometry/input_error.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace pbs {

std::string read_text_file(const std::string& path)
{
    std::error_code code;  // a named pipe would be waited for without end
    if (!std::filesystem::is_regular_file(path, code)) throw InputError(path, 0, "", "", "cannot be opened: expected a file");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(path, 0, "", "", "cannot be opened");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace pbs
