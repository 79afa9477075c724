#include "pbs/geometry/surface_checks.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/number_text.hpp"

namespace pbs {
namespace {

constexpr double farthest_m = 1e9;

}  // namespace

void check_raw_surface(const std::string& path, const IndexedPoints& mesh)
{
    if (mesh.cells.rows() == 0) throw InputError(path, 0, "triangles", "0", "expected at least one triangle");
    for (Eigen::Index i = 0; i < mesh.points.rows(); ++i)
        if (!(mesh.points.row(i).cwiseAbs().maxCoeff() <= farthest_m && mesh.points.row(i).allFinite()))
            throw InputError(path, 0, "vertex " + std::to_string(i), "", "expected finite coordinates within 1e9 m of the origin");
    require_points(path, mesh.points.rows());
    for (Eigen::Index f = 0; f < mesh.cells.rows(); ++f)
        for (Eigen::Index k = 0; k < 3; ++k)
            if (mesh.cells(f, k) < 0 || mesh.cells(f, k) >= mesh.points.rows())
                throw InputError(path, 0, "triangle " + std::to_string(f) + " vertex", std::to_string(mesh.cells(f, k)),
                                 expected_whole("an index", 0, mesh.points.rows() - 1));
}

}  // namespace pbs
