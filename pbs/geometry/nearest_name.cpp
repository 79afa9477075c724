#include "pbs/geometry/nearest_name.hpp"

#include <algorithm>
#include <numeric>

namespace pbs {
namespace {

constexpr std::size_t most_letters = 200;  // of a name that is looked for; a file may hold one of megabytes

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

std::string nearest_name(const std::string& name, const std::vector<std::string>& known)
{
    if (known.empty()) return {};
    const std::string beginning = name.substr(0, most_letters);
    return *std::min_element(known.begin(), known.end(),
                             [&](const auto& a, const auto& b) { return edit_distance(beginning, a) < edit_distance(beginning, b); });
}

}  // namespace pbs
