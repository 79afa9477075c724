#include "pbs/geometry/parts.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace pbs {

std::vector<int> parts_of(const Tets& tets)
{
    std::vector<int> parent(static_cast<std::size_t>(tets.rows()));
    std::iota(parent.begin(), parent.end(), 0);
    const auto root_of = [&](int tet) {
        while (parent[tet] != tet) tet = parent[tet] = parent[parent[tet]];
        return tet;
    };
    std::map<std::array<int, 3>, int> tet_at;
    for (int tet = 0; tet < tets.rows(); ++tet)
        for (int opposite = 0; opposite < 4; ++opposite) {
            std::array<int, 3> face = {tets(tet, (opposite + 1) % 4), tets(tet, (opposite + 2) % 4), tets(tet, (opposite + 3) % 4)};
            std::sort(face.begin(), face.end());
            const auto [other, added] = tet_at.emplace(face, tet);
            if (!added) parent[root_of(tet)] = root_of(other->second);
        }
    std::map<int, int> number;
    std::vector<int> parts;
    for (int tet = 0; tet < tets.rows(); ++tet)
        parts.push_back(number.emplace(root_of(tet), static_cast<int>(number.size())).first->second);
    return parts;
}

TetMesh kept_tets(const TetMesh& mesh, const std::vector<bool>& kept)
{
    std::vector<int> new_index(static_cast<std::size_t>(mesh.rest.rows()), -1);
    const auto tets = std::count(kept.begin(), kept.end(), true);
    for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet)
        if (kept[static_cast<std::size_t>(tet)])
            for (const int vertex : mesh.tets.row(tet)) new_index[vertex] = 0;
    int vertices = 0;
    for (int& index : new_index)
        if (index == 0) index = vertices++;

    TetMesh result;
    result.rest.resize(vertices, 3);
    result.tets.resize(tets, 4);
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v)
        if (new_index[static_cast<std::size_t>(v)] >= 0) result.rest.row(new_index[static_cast<std::size_t>(v)]) = mesh.rest.row(v);
    Eigen::Index next = 0;
    for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
        if (!kept[static_cast<std::size_t>(tet)]) continue;
        for (int corner = 0; corner < 4; ++corner) result.tets(next, corner) = new_index[mesh.tets(tet, corner)];
        ++next;
    }
    return result;
}

}  // namespace pbs
