#include "pbs/geometry/guarded_reading.hpp"

#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/packed_bytes.hpp"

#include <limits>

namespace pbs {

std::string packed(const IndexedPoints& mesh)
{
    PackedBytes bytes;
    bytes.put_array(mesh.points.data(), static_cast<std::size_t>(mesh.points.size()));
    bytes.put(static_cast<int>(mesh.cells.cols()));
    bytes.put_array(mesh.cells.data(), static_cast<std::size_t>(mesh.cells.size()));
    return bytes.text();
}

IndexedPoints unpacked_points(const std::string& bytes, const std::string& path)
{
    TakenBytes taken(bytes);
    const std::vector<double> points = taken.take_array<double>();
    const int corners = taken.take<int>();
    const std::vector<int> cells = taken.take_array<int>();
    const bool shaped = points.size() % 3 == 0 && points.size() / 3 <= std::numeric_limits<int>::max() && corners >= 0 && corners <= 4 &&
                        (corners == 0 ? cells.empty() : cells.size() % static_cast<std::size_t>(corners) == 0);
    if (!taken.whole() || !shaped) throw InputError(path, 0, "", "", "damaged: the reader's answer is not whole");

    IndexedPoints mesh;
    mesh.points = Eigen::Map<const Positions>(points.data(), static_cast<Eigen::Index>(points.size() / 3), 3);
    const Eigen::Index rows = corners == 0 ? 0 : static_cast<Eigen::Index>(cells.size()) / corners;
    mesh.cells = Eigen::Map<const decltype(mesh.cells)>(cells.data(), rows, corners);
    return mesh;
}

IndexedPoints read_guarded(const std::string& path, const std::function<IndexedPoints(const std::string&)>& read)
{
    return unpacked_points(read_isolated(path, [&](const std::string& file) { return packed(read(file)); }), path);
}

}  // namespace pbs
