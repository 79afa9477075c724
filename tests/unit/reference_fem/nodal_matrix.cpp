// Reference: the same sums in a dense matrix.
#include "reference_fem/nodal_matrix.hpp"

#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

TEST(NodalMatrix, AddsWhatADenseMatrixAdds)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1}), order);
        NodalMatrix matrix(space);
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(space.dofs(), space.dofs());
        const auto nodes = space.tet_nodes().cols();
        for (Eigen::Index t = 0; t < space.tet_nodes().rows(); ++t) {
            const Eigen::MatrixXd values = Eigen::MatrixXd::Random(3 * nodes, 3 * nodes);
            matrix.add_tet(t, values);
            for (Eigen::Index a = 0; a < nodes; ++a)
                for (Eigen::Index b = 0; b < nodes; ++b)
                    dense.block<3, 3>(3 * space.tet_nodes()(t, a), 3 * space.tet_nodes()(t, b)) += values.block<3, 3>(3 * a, 3 * b);
        }
        matrix.add_block(0, 1, Eigen::Matrix3d::Constant(2.0));
        dense.block<3, 3>(0, 3).array() += 2.0;
        EXPECT_EQ(Eigen::MatrixXd(matrix.matrix()), dense);
        matrix.set_zero();
        EXPECT_EQ(matrix.matrix().norm(), 0.0);
    }
}

}  // namespace
