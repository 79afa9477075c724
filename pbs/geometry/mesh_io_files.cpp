// Paths, sizes and index ranges: what every format needs.
#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace pbs {

namespace fs = std::filesystem;

namespace {

constexpr double least_extent_m = 1e-9;

}  // namespace

void require_readable(const std::string& path, std::uintmax_t most_bytes)
{
    std::error_code code;
    if (!fs::exists(path, code)) throw InputError(path, 0, "", "", "no such file");
    if (!fs::is_regular_file(path, code)) throw InputError(path, 0, "", "", "expected a file");
    if (!std::ifstream(path)) throw InputError(path, 0, "", "", "cannot be read");
    const std::uintmax_t bytes = fs::file_size(path, code);
    if (code) throw InputError(path, 0, "", "", "cannot be read: " + code.message());
    if (bytes == 0) throw InputError(path, 0, "", "", "the file is empty");
    require_size(path, bytes, most_bytes);
}

void require_points(const std::string& path, long long points)
{
    if (points == 0) throw InputError(path, 0, "points", "0", "expected at least one point");
}

void require_extent(const std::string& path, const Positions& points)
{
    const double extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).stableNorm();
    if (!(extent >= least_extent_m)) throw InputError(path, 0, "extent", number_text(extent), "expected at least 1e-9 m");
}

int checked_index(const std::string& path, long long tet, long long index, long long points)
{
    require_points(path, points);
    if (index < 0 || index >= points)
        throw InputError(path, 0, "tet " + std::to_string(tet) + " vertex", std::to_string(index),
                         expected_whole("an index", 0, points - 1));
    return static_cast<int>(index);
}

}  // namespace pbs
