#include "pbs/character/text_file.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

namespace pbs {
namespace {

int edit_distance(const std::string& a, const std::string& b)
{
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i) + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int substituted = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string read_text_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) throw InputError(path, 0, "", "", "cannot be opened");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& known)
{
    if (known.empty()) return {};
    return *std::min_element(known.begin(), known.end(),
                             [&](const auto& a, const auto& b) { return edit_distance(name, a) < edit_distance(name, b); });
}

}  // namespace pbs
