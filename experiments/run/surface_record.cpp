#include "experiments/run/surface_record.hpp"

#include "pbs/geometry/mesh_io.hpp"

namespace experiments {

const analysis::Columns<EmbeddedPoint> embedding_columns = {
    {"point", &EmbeddedPoint::point, "", "number of the surface's point, from 0"},
    {"tet", &EmbeddedPoint::tet, "", "number of the tet that carries it"},
    {"barycentric_0", [](auto& at) -> decltype(auto) { return (at.barycentric[0]); }, "",
     "share of the tet's first corner, in the frames' order"},
    {"barycentric_1", [](auto& at) -> decltype(auto) { return (at.barycentric[1]); }, "", "share of its second corner"},
    {"barycentric_2", [](auto& at) -> decltype(auto) { return (at.barycentric[2]); }, "", "share of its third corner"},
    {"barycentric_3", [](auto& at) -> decltype(auto) { return (at.barycentric[3]); }, "", "share of its last corner"}};

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface)
{
    std::vector<EmbeddedPoint> points;
    for (int point = 0; point < surface.tet.size(); ++point) {
        const auto share = surface.barycentric.row(point);
        points.push_back({point, surface.tet(point), {share(0), share(1), share(2), share(3)}});
    }
    return table_of(embedding_columns, points);
}

void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const std::string& folder)
{
    pbs::write_vtp(folder + "/surface_rest.vtp", pbs::embedded_positions(surface, mesh.rest, mesh.tets), surface.triangles);
    embedding_table(surface).write(folder + "/embedding.csv");
}

}  // namespace experiments
