// surface_rest.vtp and embedding.csv. Reference: an affine map preserves barycentric coordinates, inside a tet and outside.
#include "experiments/run/run_records.hpp"

#include "analysis/records/record_files.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/unit_tet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace {

using namespace experiments;

pbs::EmbeddedSurface triangle(const pbs::TetMesh& mesh)
{
    pbs::Positions points(3, 3);
    points << 0.1, 0.2, 0.3, 0.4, 0.4, 0.1, 0.9, 0.9, 0.9;  // the last point lies outside
    pbs::Triangles triangles(1, 3);
    triangles << 0, 1, 2;
    return pbs::embed(points, triangles, mesh);
}

TEST(SurfaceRecord, ItsSharesCarryThePointsAlong)
{
    const pbs::TetMesh mesh = test_support::unit_tet();
    const pbs::EmbeddedSurface surface = triangle(mesh);
    const analysis::CsvTable table = embedding_table(surface);
    const Eigen::RowVector3d shift(0.5, -2.0, 0.25);
    const pbs::Positions moved = (2.0 * mesh.rest).rowwise() + shift, carried = pbs::embedded_positions(surface, mesh.rest, mesh.tets);
    ASSERT_EQ(table.rows(), 3);
    for (int point = 0; point < 3; ++point) {
        EXPECT_EQ(table.integer(point, "point"), point);
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        double magnitudes = 0.0;
        for (int corner = 0; corner < 4; ++corner) {
            const double share = table.number(point, "barycentric_" + std::to_string(corner));
            sum += share * moved.row(mesh.tets(table.integer(point, "tet"), corner));
            magnitudes += std::abs(share);
        }
        // Three roundings make the last share one less the others, four each product and its sums, here for corners within 2.5 m; at rest
        // four of half as much.
        const double rounding = std::sqrt(3.0) * test_support::rounding_error(3 + 4 + 4 / 2, 2.5 * magnitudes);
        EXPECT_LT((sum - (2.0 * carried.row(point) + shift)).norm(), rounding);
    }
    EXPECT_LT(table.number(2, "barycentric_0"), 0.0);
}

TEST(SurfaceRecord, BothFilesStandInTheFolder)
{
    const analysis::ScratchFolder folder;
    const pbs::TetMesh mesh = test_support::unit_tet();
    write_surface(triangle(mesh), mesh, folder.path());
    EXPECT_GT(std::filesystem::file_size(folder / "surface_rest.vtp"), 0U);
    EXPECT_EQ(analysis::read_csv(folder / "embedding.csv").rows(), 3);
}

}  // namespace
