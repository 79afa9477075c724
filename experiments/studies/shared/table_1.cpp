#include "experiments/studies/shared/table_1.hpp"

#include <algorithm>
#include <limits>

namespace experiments {

using analysis::PrintedValue;

const std::array<TableOneRow, 5>& table_1()
{
    static const std::array<TableOneRow, 5> rows = {{{"Man", 1654, 6342, 4998, 1654, 33.0, 46.0, 52.0, 0.9, 90.5},
                                                     {"ManHQ", 2645, 13223, 10516, 2645, 74.2, 69.5, 72.1, 0.9, 71.1},
                                                     {"bunny", 2108, 9732, 7827, 2108, 63.3, 65.1, 68.3, 0.6, 76.8},
                                                     {"bunnyHQ", 3190, 17367, 14022, 3190, 83.5, 73.5, 76.4, 0.6, 65.8},
                                                     {"Lady", 1829, 9387, 6032, 1829, 57.2, 61.2, 64.5, 0.7, 79.5}}};
    return rows;
}

std::vector<PrintedValue> mesh_size_values()
{
    const auto range = [](const std::string& quantity, double printed, auto count, auto counted) {
        PrintedValue value{"C13", quantity, {}, printed, std::numeric_limits<double>::infinity(), 0.0};
        for (const TableOneRow& row : table_1()) {
            if (!counted(row)) continue;
            value.least = std::min<double>(value.least, count(row));
            value.most = std::max<double>(value.most, count(row));
        }
        return value;
    };
    const auto vertices = [](const TableOneRow& row) { return row.vertices; };
    const auto tets = [](const TableOneRow& row) { return row.tets; };
    const auto any = [](const TableOneRow&) { return true; };
    const auto some_2k = [](const TableOneRow& row) { return row.vertices >= 1500 && row.vertices < 2500; };
    return {range("vertices", 2000.0, vertices, any), range("tets", 10000.0, tets, any),
            range("tets_of_meshes_with_2k_vertices", 10000.0, tets, some_2k)};
}

std::vector<PrintedValue> table_1_values()
{
    constexpr double half_a_digit_ms = 0.05, half_a_digit_fps = 0.05, steps_in_1_s = 100.0;
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<PrintedValue> values;
    for (const TableOneRow& row : table_1()) {
        const analysis::CaseKey of = {.model = row.model};
        values.push_back(
            {"C14", "stretch_constraints", of, double(row.stretch), double(row.vertices + row.tets + 1), double(6 * row.tets)});
        values.push_back({"C14", "bind_constraints", of, double(row.bind), double(row.vertices), double(row.vertices)});
        values.push_back({"C14", "ct_total_ms", of, row.total_ms, row.stretch_ms + row.volume_ms - 3.0 * half_a_digit_ms, infinite});
        values.push_back({"C14", "ct_total_of_1_s_ms", of, row.total_ms,
                          steps_in_1_s * 1e3 / (row.frames_per_s + half_a_digit_fps) - half_a_digit_ms,
                          steps_in_1_s * 1e3 / (row.frames_per_s - half_a_digit_fps) + half_a_digit_ms});
    }
    return values;
}

}  // namespace experiments
