#include "pbs/flesh/flesh_system.hpp"

#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/constraint_sequence.hpp"
#include "pbs/system/module.hpp"

#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

namespace pbs {
namespace {

// The function of the module pbskin_cholmod: fills in the factor, or leaves it empty if the matrix is not positive
// definite.
using FactorFunction = void(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& order,
                            CholeskyFactor& factor);

// The plain implementation: the energy in file order and a loop per entry of the factor, in double. Energy: FleshEnergy
// or ProjectiveEnergy.
template <typename Energy>
class PlainSystem : public FleshSystem<double> {
public:
    PlainSystem(const Energy& energy, const CholeskyFactor& factor)
        : FleshSystem(static_cast<int>(energy.hold().size())), energy_(energy), factor_(factor)
    {
    }

    void set_centres(const Positions& centres) override { centres_ = centres; }
    double value_and_gradient(const Rows<double>& x, Rows<double>& gradient) override
    {
        store(x, x_);
        const double value = energy_.value_and_gradient(x_, centres_, gradient_);
        load(gradient_, gradient);
        return value;
    }
    void precondition(Rows<double>& residual) override
    {
        store(residual, gradient_);
        load(solve_plainly(factor_, gradient_), residual);
    }
    double dot(const Rows<double>& a, const Rows<double>& b) const override
    {
        double sum = 0.0;
        for (const int i : place_)
            for (int axis = 0; axis < 3; ++axis) sum += a[i][axis] * b[i][axis];
        return sum;
    }
    void add(double factor, const Rows<double>& a, Rows<double>& to) const override
    {
        for (const int i : place_)
            for (int axis = 0; axis < 3; ++axis) to[i][axis] += factor * a[i][axis];
    }

private:
    Energy energy_;
    CholeskyFactor factor_;
    Positions centres_, x_, gradient_;
};

// The tets of one slab, sixteen side by side: one specialisation for each energy.
template <typename Scalar, typename Energy>
struct PackedTets;

template <typename Scalar>
struct PackedTets<Scalar, FleshEnergy> {
    explicit PackedTets(const FleshEnergy&) {}

    void set_tet(FleshBatch<Scalar>& batch, int lane, const FleshTet& tet)
    {
        for (int e = 0; e < 6; ++e) batch.w[e][lane] = Scalar(tet.w[e]);
        batch.kappa[lane] = Scalar(tet.kappa);
        batch.d[lane] = Scalar(tet.d);
    }
    double add_gradient(const Scalar* x, Scalar* gradient)
    {
        return add_gradient_of_tets(batches.data(), static_cast<int>(batches.size()), x, gradient);
    }

    std::vector<FleshBatch<Scalar>> batches;
    int refused_count = 0;
};

// A tet whose shapes the kernel refuses is computed by projective_forces.
template <typename Scalar>
struct PackedTets<Scalar, ProjectiveEnergy> {
    explicit PackedTets(const ProjectiveEnergy& energy) : weights(energy.weights()) {}

    void set_tet(ProjectiveBatch<Scalar>& batch, int lane, const ProjectiveTet& tet)
    {
        for (int k = 0; k < 9; ++k) batch.inverse_edges[k][lane] = Scalar(tet.inverse_edges(k / 3, k % 3));
        batch.volume[lane] = Scalar(tet.volume);
        for (int e = 0; e < 6; ++e) batch.w[e][lane] = Scalar(tet.w[e]);
    }
    double add_gradient(const Scalar* x, Scalar* gradient)
    {
        refused_count = 0;
        refused.resize(batch_size * batches.size());
        double value =
            add_gradient_of_projective_tets(batches.data(), static_cast<int>(batches.size()), Scalar(weights.strain),
                                            Scalar(weights.volume), x, gradient, refused.data(), &refused_count);
        for (int i = 0; i < refused_count; ++i) value += add_gradient_of_refused(refused[i], x, gradient);
        return value;
    }
    double add_gradient_of_refused(int place, const Scalar* x, Scalar* gradient) const
    {
        const ProjectiveBatch<Scalar>& batch = batches[place / batch_size];
        const int lane = place % batch_size;
        const auto corner = [&](int i) {
            return Vec3(
                Eigen::Map<const Eigen::Matrix<Scalar, 3, 1>>(x + batch.offset[i][lane]).template cast<double>());
        };
        ProjectiveTet tet{{}, {}, double(batch.volume[lane]), {}};
        for (int k = 0; k < 9; ++k) tet.inverse_edges(k / 3, k % 3) = double(batch.inverse_edges[k][lane]);
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = corner(k + 1) - corner(0);
        const ProjectiveForces forces = projective_forces(tet, weights, edges);
        for (int axis = 0; axis < 3; ++axis) {
            for (int k = 0; k < 3; ++k) gradient[batch.offset[k + 1][lane] + axis] += Scalar(forces.columns(axis, k));
            gradient[batch.offset[0][lane] + axis] -= Scalar(forces.columns.row(axis).sum());
        }
        return forces.value;
    }

    ProjectiveWeights weights;
    std::vector<ProjectiveBatch<Scalar>> batches;
    std::vector<int> refused;  // room for the places, 16 batch + lane, of refused tets
    int refused_count = 0;     // in the last call of add_gradient
};

// The packed implementation: sixteen tets that share no vertex side by side, in the order of memory of the solvers of
// Algorithm 1. Threads share the slabs of the mesh; their number changes no bit. The energy is read in the constructor
// alone.
template <typename Scalar, typename Energy>
class PackedSystem : public FleshSystem<Scalar> {
public:
    PackedSystem(TetSlabs slabs, const Energy& energy, const CholeskyFactor& factor)
        : FleshSystem<Scalar>(slabs.order().new_of_old, slabs.rows()),
          slabs_(std::move(slabs)),
          slab_energy_(slabs_.slabs()),
          centres_(slabs_.rows()),
          solve_(factor, this->place_)
    {
        for (int slab = 0; slab < slabs_.slabs(); ++slab) {
            PackedTets<Scalar, Energy>& packed = tets_.emplace_back(energy);
            slabs_.fill(slab, slabs_.batches(slabs_.of_slab(slab)), packed.batches,
                        [&](int b, int lane, int tet) { packed.set_tet(packed.batches[b], lane, energy.tets()[tet]); });
        }
        for (std::size_t i = 0; i < this->place_.size(); ++i) centres_[this->place_[i]][3] = Scalar(energy.hold()(i));
    }

    void set_centres(const Positions& centres) override
    {
        this->origin_ = load_held_centres(centres, this->place_, centres_);
    }
    double value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient) override
    {
        const double of_hold = set_gradient_of_hold(centres_.data(), centres_.size(), x.data(), gradient.data());
        slabs_.for_each([&](int slab) { slab_energy_[slab] = tets_[slab].add_gradient(x.data(), gradient.data()); });
        return std::accumulate(slab_energy_.begin(), slab_energy_.end(), of_hold);
    }
    void precondition(Rows<Scalar>& residual) override { solve_.apply(residual.data()); }
    double dot(const Rows<Scalar>& a, const Rows<Scalar>& b) const override
    {
        return pbs::dot(a.data(), b.data(), a.size());
    }
    void add(double factor, const Rows<Scalar>& a, Rows<Scalar>& to) const override
    {
        pbs::add(Scalar(factor), a.data(), a.size(), to.data());
    }
    int refused() const override
    {
        return std::accumulate(tets_.begin(), tets_.end(), 0,
                               [](int sum, const auto& slab) { return sum + slab.refused_count; });
    }

private:
    TetSlabs slabs_;
    std::vector<PackedTets<Scalar, Energy>> tets_;  // of each slab
    std::vector<double> slab_energy_;
    Rows<Scalar> centres_;  // c_i - origin, a_i
    TriangularSolve<Scalar> solve_;
};

}  // namespace

HeldFlesh::HeldFlesh(const TetMesh& mesh, const BoneSprings& springs, int bones, const HeldFleshOptions& options)
    : hold_(mesh, springs, bones), energy_(mesh, flesh_material(options.poisson), hold_)
{
    if (!(hold_.stiffness().sum() > 0.0))
        throw InputError("flesh", 0, "springs", std::to_string(springs.points.rows()),
                         "expected one that lies inside the tets");
    factor_ = cholesky_factor(flesh_laplacian(mesh, flesh_material(options.poisson), energy_, options.volume_share));
    if (!factor_.usable())
        throw InputError("flesh", 0, "Laplacian", std::to_string(mesh.rest.rows()) + " vertices",
                         "expected tets whose Laplacian is positive definite in double; are some of them flat?");
}

Weights HeldFlesh::smooth_weights(const Weights& otherwise) const
{
    constexpr double negligible = 1e-3;
    return sparse_weights(solve_plainly(factor_, hold_.stiffness_of_bones()), negligible, otherwise);
}

CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& order)
{
    CholeskyFactor factor;
    load_module("pbskin_cholmod").function<FactorFunction>("pbskin_cholmod_ordered_factor")(lower, order, factor);
    return factor;
}

int width_of_supernode(const CholeskyFactor& factor, int column, int widest)
{
    const int columns = static_cast<int>(factor.order.size());
    int width = 1;
    while (width < widest && column + width < columns) {
        const int last = column + width - 1;
        const int entries = factor.first[last + 1] - factor.first[last],
                  next = factor.first[last + 2] - factor.first[last + 1];
        // The rows of a column below its diagonal are among those of the column of the first of them (elimination
        // tree).
        const bool is_parent = entries > 1 && factor.row[factor.first[last] + 1] == last + 1;
        if (!is_parent || entries != next + 1) break;
        ++width;
    }
    return width;
}

template <typename Scalar>
TriangularSolve<Scalar>::TriangularSolve(const CholeskyFactor& factor, const std::vector<int>& place)
{
    const int columns = static_cast<int>(factor.order.size());
    for (const int row : factor.order) place_.push_back(4u * place[row]);
    for (int column = 0; column < columns;) {
        const int width = width_of_supernode(factor, column, widest_supernode);
        const int last = column + width - 1;
        Supernode node{column, width, factor.first[last + 1] - factor.first[last] - 1, below_.size(), values_.size()};
        const auto entry = [&](int row_in_column, int c) {
            return factor.value[factor.first[column + c] + row_in_column - c];
        };
        for (int row = 0; row < width; ++row) {
            for (int c = 0; c < row; ++c) values_.push_back(Scalar(entry(row, c)));
            values_.push_back(Scalar(1.0 / entry(row, row)));
        }
        for (int k = 0; k < node.rows_below; ++k) {
            below_.push_back(4u * factor.row[factor.first[last] + 1 + k]);
            for (int c = 0; c < width; ++c) values_.push_back(Scalar(entry(width + k, c)));
        }
        supernodes_.push_back(node);
        column += width;
    }
    work_ = Rows<Scalar>(static_cast<int>(factor.order.size()));
}

template <typename Scalar>
void TriangularSolve<Scalar>::apply(Scalar* rows)
{
    solve_supernodes(supernodes_.data(), static_cast<int>(supernodes_.size()), below_.data(), values_.data(),
                     place_.data(), static_cast<int>(place_.size()), rows, work_.data());
}

Eigen::MatrixXd solve_plainly(const CholeskyFactor& factor, const Eigen::MatrixXd& b)
{
    const auto rows = static_cast<Eigen::Index>(factor.order.size()),
               entries = static_cast<Eigen::Index>(factor.value.size());
    const Eigen::Map<const Eigen::SparseMatrix<double>> L(rows, rows, entries, factor.first.data(), factor.row.data(),
                                                          factor.value.data());
    Eigen::MatrixXd permuted = b(factor.order, Eigen::all), x(b.rows(), b.cols());
    L.triangularView<Eigen::Lower>().solveInPlace(permuted);
    L.transpose().triangularView<Eigen::Upper>().solveInPlace(permuted);
    x(factor.order, Eigen::all) = permuted;
    return x;
}

template class TriangularSolve<float>;
template class TriangularSolve<double>;

template <typename Scalar, typename Energy>
std::unique_ptr<FleshSystem<Scalar>> make_flesh_system(const TetMesh& mesh, const Energy& energy,
                                                       const CholeskyFactor& factor, bool packed, int threads)
{
    if constexpr (std::is_same_v<Scalar, double>)
        if (!packed) return std::make_unique<PlainSystem<Energy>>(energy, factor);
    TetSlabs slabs(mesh.tets, static_cast<int>(mesh.rest.rows()), threads);
    return std::make_unique<PackedSystem<Scalar, Energy>>(std::move(slabs), energy, factor);
}

template std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh&, const FleshEnergy&,
                                                               const CholeskyFactor&, bool, int);
template std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh&, const FleshEnergy&,
                                                                const CholeskyFactor&, bool, int);
template std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh&, const ProjectiveEnergy&,
                                                               const CholeskyFactor&, bool, int);
template std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh&, const ProjectiveEnergy&,
                                                                const CholeskyFactor&, bool, int);

}  // namespace pbs
