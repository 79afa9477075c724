// The module pbskin_cholmod: analysis and factorisation of a sparse matrix. The simplicial method calls no BLAS, so
// that the factor is the same for each of its kernels and each number of its threads.
#include "pbs/flesh/flesh_system.hpp"

#include "pbs/system/deferred_sigterm.hpp"

#include <cholmod.h>

namespace {

// CHOLMOD's view of the matrix, without a copy.
cholmod_sparse view(const Eigen::SparseMatrix<double>& lower)
{
    cholmod_sparse sparse{};
    sparse.nrow = sparse.ncol = lower.rows();
    sparse.nzmax = lower.nonZeros();
    sparse.p = const_cast<int*>(lower.outerIndexPtr());
    sparse.i = const_cast<int*>(lower.innerIndexPtr());
    sparse.x = const_cast<double*>(lower.valuePtr());
    sparse.stype = -1;
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = CHOLMOD_REAL;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.sorted = sparse.packed = 1;
    return sparse;
}

void copy(const cholmod_factor& from, pbs::CholeskyFactor& to)
{
    const auto* order = static_cast<const int*>(from.Perm);
    const auto* first = static_cast<const int*>(from.p);
    const auto* row = static_cast<const int*>(from.i);
    const auto* value = static_cast<const double*>(from.x);
    to.order.assign(order, order + from.n);
    to.first.assign(first, first + from.n + 1);
    to.row.assign(row, row + first[from.n]);
    to.value.assign(value, value + first[from.n]);
}

}  // namespace

extern "C" void pbskin_cholmod_ordered_factor(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& order,
                                              pbs::CholeskyFactor& factor);

void pbskin_cholmod_ordered_factor(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& order,
                                   pbs::CholeskyFactor& factor)
{
    factor = {};
    cholmod_common common;
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = common.final_pack = common.final_monotonic = 1;
    cholmod_sparse matrix = view(lower);
    if (!order.empty()) {
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
        common.postorder = 0;
    }
    cholmod_factor* cholmod = nullptr;
    {
        const pbs::DeferredSigterm deferred;
        cholmod =
            cholmod_analyze_p(&matrix, order.empty() ? nullptr : const_cast<int*>(order.data()), nullptr, 0, &common);
    }
    if (cholmod) cholmod_factorize(&matrix, cholmod, &common);
    if (cholmod && common.status == CHOLMOD_OK && cholmod->minor == cholmod->n) copy(*cholmod, factor);
    if (cholmod) cholmod_free_factor(&cholmod, &common);
    cholmod_finish(&common);
}
