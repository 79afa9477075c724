#include "experiments/run/surface_record.hpp"

#include "pbs/geometry/mesh_io.hpp"

namespace experiments {

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface)
{
    analysis::CsvTable table({"point", "tet", "barycentric_0", "barycentric_1", "barycentric_2", "barycentric_3"});
    for (int point = 0; point < surface.tet.size(); ++point) {
        const auto share = surface.barycentric.row(point);
        table.add_row({point, surface.tet(point), share(0), share(1), share(2), share(3)});
    }
    return table;
}

void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const std::string& folder)
{
    pbs::write_vtp(folder + "/surface_rest.vtp", pbs::embedded_positions(surface, mesh.rest, mesh.tets), surface.triangles);
    embedding_table(surface).write(folder + "/embedding.csv");
}

}  // namespace experiments
