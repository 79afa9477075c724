#include "reference_fem/linear_solvers.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/system/deferred_sigterm.hpp"

#include <cholmod.h>
#include <dlfcn.h>
#include <umfpack.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <limits>

extern "C" void dgemm_();

namespace reference_fem {
namespace {

// Functions of OpenBLAS and of OpenMP, looked up at run time: the program must also run on another BLAS, and with a
// CHOLMOD without OpenMP.
template <typename Function>
Function* find(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

std::string file_of(void (*function)())
{
    Dl_info info{};
    if (!dladdr(reinterpret_cast<void*>(function), &info) || !info.dli_fname) return "unknown file";
    char resolved[PATH_MAX];
    return realpath(info.dli_fname, resolved) ? resolved : info.dli_fname;
}

// While this exists, OpenMP gives the calling thread no other threads. CHOLMOD 3 would share the assembly of every
// supernode among four of them, and OMP_NUM_THREADS does not change that number. It takes as long to wake them as to
// factorise with one thread. The threads share no sum, so that the result is the same.
class OneOpenMpThread {
public:
    OneOpenMpThread()
    {
        if (set_levels_) set_levels_(0);
    }
    ~OneOpenMpThread()
    {
        if (set_levels_) set_levels_(before_);
    }
    OneOpenMpThread(const OneOpenMpThread&) = delete;
    OneOpenMpThread& operator=(const OneOpenMpThread&) = delete;

private:
    void (*set_levels_)(int) = find<void(int)>("omp_set_max_active_levels");
    int before_ = set_levels_ ? find<int()>("omp_get_max_active_levels")() : 0;
};

static_assert(sizeof(SuiteSparse_long) == sizeof(SparseMatrix::StorageIndex));

// CHOLMOD's view of the upper triangle, without a copy.
cholmod_sparse view(const SparseMatrix& matrix)
{
    cholmod_sparse sparse{};
    sparse.nrow = matrix.rows();
    sparse.ncol = matrix.cols();
    sparse.nzmax = matrix.nonZeros();
    sparse.p = const_cast<SparseMatrix::StorageIndex*>(matrix.outerIndexPtr());
    sparse.i = const_cast<SparseMatrix::StorageIndex*>(matrix.innerIndexPtr());
    sparse.x = const_cast<double*>(matrix.valuePtr());
    sparse.stype = 1;
    sparse.itype = CHOLMOD_LONG;
    sparse.xtype = CHOLMOD_REAL;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.sorted = 1;
    sparse.packed = 1;
    return sparse;
}

cholmod_dense view(const Eigen::VectorXd& vector)
{
    cholmod_dense dense{};
    dense.nrow = dense.d = dense.nzmax = vector.size();
    dense.ncol = 1;
    dense.x = const_cast<double*>(vector.data());
    dense.xtype = CHOLMOD_REAL;
    dense.dtype = CHOLMOD_DOUBLE;
    return dense;
}

// The pattern of the blocks of a symmetric matrix, upper triangle. All columns of a block have the same rows, so that
// its first one is read. The values are unused.
SparseMatrix blocks_of(const SparseMatrix& matrix, int size)
{
    SparseMatrix blocks(matrix.rows() / size, matrix.cols() / size);
    blocks.reserve(matrix.nonZeros() / (size * size));
    for (Eigen::Index column = 0; column < blocks.cols(); ++column) {
        blocks.startVec(column);
        Eigen::Index last = -1;
        for (SparseMatrix::InnerIterator entry(matrix, column * size); entry && entry.row() < (column + 1) * size;
             ++entry)
            if (const Eigen::Index row = entry.row() / size; row != last) blocks.insertBack(last = row, column) = 1.0;
    }
    blocks.finalize();
    return blocks;
}

// CHOLMOD: Y. Chen, T. Davis, W. Hager, S. Rajamanickam, Algorithm 887, ACM TOMS 35(3), 2008.
// The rows of a node are ordered as one: a ninth of the entries, so that a pattern that changes with every contact is
// analysed quickly.
class CholmodFactor : public PreparedSolver {
public:
    CholmodFactor(const SparseMatrix& matrix, int block_size) : matrix_(matrix)
    {
        cholmod_l_start(&common_);
        common_.print = 0;
        common_.supernodal = CHOLMOD_SUPERNODAL;
        // Supernodes are merged more than by default: a tenth more zeros, a quarter less time on 7K dofs, a tenth less
        // on 50K.
        std::copy_n(std::array{16, 48, 96}.begin(), 3, common_.nrelax);
        std::copy_n(std::array{0.9, 0.3, 0.1}.begin(), 3, common_.zrelax);
        const pbs::Stopwatch analysis;
        std::vector<SuiteSparse_long> order = order_of(blocks_of(matrix, block_size), block_size);
        cholmod_sparse sparse = view(matrix);
        common_.nmethods = 1;
        common_.method[0].ordering = CHOLMOD_GIVEN;
        factor_ = cholmod_l_analyze_p(&sparse, order.data(), nullptr, 0, &common_);
        analyse_s_ = analysis.seconds();
        refactor();
    }

    void refactor() final
    {
        usable_ = matrix_.rows() == 0;  // nothing to solve for
        if (!factor_) return;
        const OneOpenMpThread alone;
        cholmod_sparse sparse = view(matrix_);
        const pbs::Stopwatch factorisation;
        cholmod_l_factorize(&sparse, factor_, &common_);
        factor_s_ = factorisation.seconds();
        if (common_.status != CHOLMOD_OK || factor_->minor < factor_->n) return;  // not positive definite
        reciprocal_condition_ = cholmod_l_rcond(factor_, &common_);
        usable_ = reciprocal_condition_ > std::numeric_limits<double>::epsilon();
    }

    ~CholmodFactor() override
    {
        for (cholmod_dense** dense : {&solution_, &work_, &permuted_})
            if (*dense) cholmod_l_free_dense(dense, &common_);
        if (factor_) cholmod_l_free_factor(&factor_, &common_);
        cholmod_l_finish(&common_);
    }

    CholmodFactor(const CholmodFactor&) = delete;
    CholmodFactor& operator=(const CholmodFactor&) = delete;

    Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override
    {
        if (right_hand_side.size() == 0) return right_hand_side;
        cholmod_dense dense = view(right_hand_side);
        if (!cholmod_l_solve2(CHOLMOD_A, factor_, &dense, nullptr, &solution_, nullptr, &work_, &permuted_, &common_))
            return Eigen::VectorXd::Constant(right_hand_side.size(), std::numeric_limits<double>::quiet_NaN());
        return Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution_->x), right_hand_side.size());
    }

    std::string name() const override
    {
        int version[3];
        cholmod_l_version(version);
        return "CHOLMOD " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." +
               std::to_string(version[2]) + (is_metis_ ? " supernodal, METIS" : " supernodal, AMD");
    }

private:
    // The order of the blocks by AMD or by METIS, whichever gives the smaller factor, written out for their rows. METIS
    // is cheap on blocks; on single rows it is tried only where CHOLMOD finds much fill in AMD's.
    std::vector<SuiteSparse_long> order_of(const SparseMatrix& blocks, int block_size)
    {
        if (block_size > 1) {
            common_.nmethods = 2;
            common_.method[0].ordering = CHOLMOD_AMD;
            common_.method[1].ordering = CHOLMOD_METIS;
        }
        cholmod_sparse sparse = view(blocks);
        const pbs::DeferredSigterm deferred;
        cholmod_factor* factor = cholmod_l_analyze(&sparse, &common_);
        if (!factor) return {};
        is_metis_ = factor->ordering == CHOLMOD_METIS;
        std::vector<SuiteSparse_long> order;
        for (Eigen::Index k = 0; k < blocks.rows(); ++k)
            for (int row = 0; row < block_size; ++row)
                order.push_back(block_size * static_cast<const SuiteSparse_long*>(factor->Perm)[k] + row);
        cholmod_l_free_factor(&factor, &common_);
        return order;
    }

    const SparseMatrix& matrix_;
    bool is_metis_ = false;
    mutable cholmod_common common_;
    cholmod_factor* factor_ = nullptr;
    mutable cholmod_dense *solution_ = nullptr, *work_ = nullptr, *permuted_ = nullptr;
};

// UMFPACK: T. Davis, Algorithm 832, ACM TOMS 30(2), 2004. It knows nothing of symmetry: a second opinion on the same
// matrix.
class UmfpackFactor : public PreparedSolver {
public:
    explicit UmfpackFactor(const SparseMatrix& matrix) : matrix_(matrix)
    {
        umfpack_dl_defaults(control_);
        control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
        control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;  // half the fill and time of AMD on P2
        control_[UMFPACK_IRSTEP] = 0;                         // refinement took thrice the time for half the residual
        const pbs::Stopwatch analysis;
        {
            const pbs::DeferredSigterm deferred;
            umfpack_dl_symbolic(matrix.rows(), matrix.cols(), columns(), rows(), matrix.valuePtr(), &symbolic_,
                                control_, nullptr);
        }
        analyse_s_ = analysis.seconds();
        refactor();
    }

    void refactor() final
    {
        usable_ = false;
        if (!symbolic_) return;
        if (numeric_) umfpack_dl_free_numeric(&numeric_);
        double info[UMFPACK_INFO] = {};
        const pbs::Stopwatch factorisation;
        const auto status =
            umfpack_dl_numeric(columns(), rows(), matrix_.valuePtr(), symbolic_, &numeric_, control_, info);
        factor_s_ = factorisation.seconds();
        reciprocal_condition_ = info[UMFPACK_RCOND];
        usable_ = status == UMFPACK_OK && reciprocal_condition_ > std::numeric_limits<double>::epsilon();
    }

    ~UmfpackFactor() override
    {
        if (numeric_) umfpack_dl_free_numeric(&numeric_);
        if (symbolic_) umfpack_dl_free_symbolic(&symbolic_);
    }

    UmfpackFactor(const UmfpackFactor&) = delete;
    UmfpackFactor& operator=(const UmfpackFactor&) = delete;

    Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override
    {
        Eigen::VectorXd solution(right_hand_side.size());
        const auto status = umfpack_dl_solve(UMFPACK_A, columns(), rows(), matrix_.valuePtr(), solution.data(),
                                             right_hand_side.data(), numeric_, control_, nullptr);
        if (status != UMFPACK_OK) solution.setConstant(std::numeric_limits<double>::quiet_NaN());
        return solution;
    }

    std::string name() const override { return UMFPACK_VERSION; }

private:
    const SuiteSparse_long* columns() const { return matrix_.outerIndexPtr(); }
    const SuiteSparse_long* rows() const { return matrix_.innerIndexPtr(); }

    const SparseMatrix& matrix_;
    double control_[UMFPACK_CONTROL] = {};
    void *symbolic_ = nullptr, *numeric_ = nullptr;
};

constexpr int not_in_block = -1;

std::vector<int> places(const std::vector<int>& kept, Eigen::Index size)
{
    std::vector<int> place(size, not_in_block);
    for (std::size_t k = 0; k < kept.size(); ++k) place[kept[k]] = static_cast<int>(k);
    return place;
}

bool are_whole_nodes(const std::vector<int>& dofs)
{
    for (std::size_t k = 0; k < dofs.size(); ++k)
        if (dofs[k] % 3 != static_cast<int>(k % 3) || (k % 3 > 0 && dofs[k] != dofs[k - 1] + 1)) return false;
    return dofs.size() % 3 == 0;
}

}  // namespace

std::string resolved_blas()
{
    auto* config = find<char*()>("openblas_get_config");
    const std::string library = config ? config() : "not OpenBLAS";
    const std::string file = file_of(&dgemm_);
    return library + " (" + file.substr(file.rfind('/') + 1) + ")";
}

void use_one_blas_thread()
{
    const pbs::SigtermTakenElsewhere elsewhere;  // after a fork OpenBLAS starts its threads anew
    if (auto* set_threads = find<void(int)>("openblas_set_num_threads")) set_threads(1);
}

std::unique_ptr<PreparedSolver> prepare_cholmod(const SparseMatrix& matrix, int block_size)
{
    require(block_size > 0 && matrix.rows() % block_size == 0, "block_size", block_size,
            "expected a divisor of the number of rows");
    return std::make_unique<CholmodFactor>(matrix, block_size);
}

std::unique_ptr<PreparedSolver> prepare_umfpack(const SparseMatrix& matrix)
{
    return std::make_unique<UmfpackFactor>(matrix);
}

std::unique_ptr<PreparedSolver> prepare(const SparseMatrix& matrix, LinearSolver solver, int block_size)
{
    use_one_blas_thread();
    switch (solver) {
        case LinearSolver::umfpack:
            return prepare_umfpack(matrix);
        case LinearSolver::cholmod:
            break;
    }
    return prepare_cholmod(matrix, block_size);
}

EliminatedSystem::Block EliminatedSystem::block(const SparseMatrix& matrix, const std::vector<int>& rows,
                                                const std::vector<int>& columns)
{
    const std::vector<int> row_place = places(rows, matrix.rows());
    Block kept{SparseMatrix(rows.size(), columns.size()), {}};
    for (std::size_t c = 0; c < columns.size(); ++c) {
        kept.matrix.startVec(c);
        for (auto k = matrix.outerIndexPtr()[columns[c]]; k < matrix.outerIndexPtr()[columns[c] + 1]; ++k) {
            const int row = row_place[matrix.innerIndexPtr()[k]];
            if (row == not_in_block) continue;
            kept.matrix.insertBack(row, c) = matrix.valuePtr()[k];
            kept.source.push_back(k);
        }
    }
    kept.matrix.finalize();
    return kept;
}

EliminatedSystem::EliminatedSystem(const SparseMatrix& stiffness, const std::vector<bool>& prescribed,
                                   LinearSolver solver)
{
    for (std::size_t i = 0; i < prescribed.size(); ++i)
        (prescribed[i] ? prescribed_ : free_).push_back(static_cast<int>(i));
    free_free_ = block(stiffness, free_, free_);
    free_prescribed_ = block(stiffness, free_, prescribed_);
    factor_ = prepare(free_free_.matrix, solver, are_whole_nodes(free_) ? 3 : 1);
}

void EliminatedSystem::update(const SparseMatrix& stiffness)
{
    for (Block* kept : {&free_free_, &free_prescribed_})
        for (std::size_t k = 0; k < kept->source.size(); ++k)
            kept->matrix.valuePtr()[k] = stiffness.valuePtr()[kept->source[k]];
    factor_->refactor();
}

EliminatedSolution EliminatedSystem::solve(const Eigen::VectorXd& load, const Eigen::VectorXd& prescribed_values) const
{
    EliminatedSolution solution{prescribed_values, 0.0};
    const Eigen::VectorXd right_hand_side = load(free_) - free_prescribed_.matrix * prescribed_values(prescribed_);
    if (free_.empty()) return solution;
    if (!factor_->usable()) {
        solution.displacement.setConstant(std::numeric_limits<double>::quiet_NaN());
        solution.residual = std::numeric_limits<double>::infinity();
        return solution;
    }
    const Eigen::VectorXd free_values = factor_->solve(right_hand_side);
    solution.displacement(free_) = free_values;
    const double defect = (free_free_.matrix * free_values - right_hand_side).norm();
    solution.residual = defect == 0.0 ? 0.0 : defect / right_hand_side.norm();
    return solution;
}

}  // namespace reference_fem
