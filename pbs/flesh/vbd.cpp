#include "pbs/flesh/vbd.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/rows.hpp"
#include "pbs/packed/vertex_order.hpp"

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

namespace pbs {
namespace {

VertexBlockOptions checked(const VertexBlockOptions& options)
{
    if (!(options.omega > 0.0 && options.omega < 2.0))
        throw InputError("vertex block descent", 0, "omega", std::to_string(options.omega), "expected 0 < omega < 2");
    if (!(options.rho >= 0.0 && options.rho < 1.0))
        throw InputError("vertex block descent", 0, "rho", std::to_string(options.rho), "expected 0 <= rho < 1");
    return options;
}

// The edge between two corners, as its number in 01 02 03 12 13 23.
constexpr int edge_between[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
// The other corners, so that n points to the corner where V > 0.
constexpr int others_of_corner[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

constexpr int vertices_of_chunk = 512;       // some 10 us of work
constexpr int vertices_for_threads = 16384;  // fewer are done sooner than threads wake

// One vertex after the other, in double.
class PlainVertexSweep : public VertexSweep<double> {
public:
    PlainVertexSweep(const TetMesh& mesh, const FleshEnergy& energy)
        : VertexSweep(static_cast<int>(mesh.rest.rows())),
          stars_(vertex_stars(energy)),
          colours_(vertex_colours(mesh.tets, static_cast<int>(mesh.rest.rows())))
    {
    }

    void set_centres(const Positions& centres) override { centres_ = centres; }
    void move(double omega, Rows<double>& x) override
    {
        store(x, x_);
        for (const std::vector<int>& colour : colours_)
            for (const int i : colour)
                x_.row(i) -= omega * block_step(vertex_block(stars_[i], i, x_, centres_)).transpose();
        load(x_, x);
    }
    VertexHold hold(int vertex) const override
    {
        return {centres_.row(vertex), stars_[vertex].hold, stars_[vertex].diagonal};
    }
    void set_hold(int vertex, const VertexHold& hold) override
    {
        centres_.row(vertex) = hold.centre;
        stars_[vertex].hold = hold.stiffness;
        stars_[vertex].diagonal = hold.diagonal;
    }
    void extrapolate(double omega, const Rows<double>& before, Rows<double>& x) const override
    {
        for (const int i : place_)
            for (int axis = 0; axis < 3; ++axis) x[i][axis] = before[i][axis] + omega * (x[i][axis] - before[i][axis]);
    }

private:
    std::vector<VertexStar> stars_;  // #V
    std::vector<std::vector<int>> colours_;
    Positions centres_, x_;
};

// Sixteen vertices of one colour side by side. The vertices of a colour are cut into chunks of neighbouring ones; in a
// chunk they are sorted by their number of tets, so that few lanes wait for others. Threads share the chunks of a
// colour. Their number changes no bit, because no vertex of a colour reads another one. Sixteen dummies follow the rows
// of the vertices.
template <typename Scalar>
class PackedVertexSweep : public VertexSweep<Scalar> {
public:
    PackedVertexSweep(const TetMesh& mesh, const FleshEnergy& energy, int threads)
        : VertexSweep<Scalar>(breadth_first(mesh.tets, static_cast<int>(mesh.rest.rows())).new_of_old,
                              static_cast<int>(mesh.rest.rows()) + batch_size),
          parallel_(mesh.rest.rows() >= vertices_for_threads ? threads : 1),
          lane_of_(mesh.rest.rows()),
          centres_(this->rows_)
    {
        const std::vector<VertexStar> stars = vertex_stars(energy);
        for (const std::vector<int>& colour : vertex_colours(mesh.tets, static_cast<int>(mesh.rest.rows()))) {
            colours_.emplace_back();
            for (auto begin = colour.begin(); begin != colour.end();) {
                const auto end = begin + std::min<std::ptrdiff_t>(vertices_of_chunk, colour.end() - begin);
                add_chunk(stars, {begin, end});
                begin = end;
            }
        }
        for (std::size_t i = 0; i < stars.size(); ++i) centres_[this->place_[i]][3] = Scalar(stars[i].hold);
    }

    void set_centres(const Positions& centres) override
    {
        this->origin_ = load_held_centres(centres, this->place_, centres_);
    }
    void move(double omega, Rows<Scalar>& x) override
    {
        for (const std::vector<Chunk>& chunks : colours_)
            parallel_.for_each(static_cast<int>(chunks.size()), [&](int c) {
                move_vertices(batches_.data() + chunks[c].first, chunks[c].count, incidences_.data(), centres_.data(),
                              Scalar(omega), x.data());
            });
    }
    VertexHold hold(int vertex) const override
    {
        const Scalar* centre = centres_[this->place_[vertex]];
        const auto [batch, lane] = lane_of_[vertex];
        return {Vec3(centre[0], centre[1], centre[2]), centre[3], batches_[batch].diagonal[lane]};
    }
    void set_hold(int vertex, const VertexHold& hold) override
    {
        Scalar* centre = centres_[this->place_[vertex]];
        const auto [batch, lane] = lane_of_[vertex];
        for (int axis = 0; axis < 3; ++axis) centre[axis] = Scalar(hold.centre(axis));
        centre[3] = Scalar(hold.stiffness);
        batches_[batch].diagonal[lane] = Scalar(hold.diagonal);
    }
    void extrapolate(double omega, const Rows<Scalar>& before, Rows<Scalar>& x) const override
    {
        pbs::extrapolate(Scalar(omega), before.data(), x.size(), x.data());
    }

private:
    struct Chunk {
        int first = 0, count = 0;  // batches
    };

    void add_chunk(const std::vector<VertexStar>& stars, std::vector<int> vertices)
    {
        std::stable_sort(vertices.begin(), vertices.end(),
                         [&](int a, int b) { return stars[a].tets.size() > stars[b].tets.size(); });
        const int before = static_cast<int>(batches_.size()), count = static_cast<int>(vertices.size());
        for (int first = 0; first < count; first += batch_size)
            add_batch(stars, vertices.data() + first, std::min(batch_size, count - first));
        colours_.back().push_back({before, static_cast<int>(batches_.size()) - before});
    }

    void add_batch(const std::vector<VertexStar>& stars, const int* vertices, int count)
    {
        VertexBatch<Scalar>& batch = batches_.emplace_back();
        batch.first = incidences_.size();
        batch.count = static_cast<int>(stars[vertices[0]].tets.size());
        incidences_.resize(batch.first + batch.count);
        for (int lane = 0; lane < batch_size; ++lane) {
            const VertexStar none, &star = lane < count ? stars[vertices[lane]] : none;
            const std::uint32_t own =
                4u * (lane < count ? this->place_[vertices[lane]] : this->rows_ - batch_size + lane);
            if (lane < count) lane_of_[vertices[lane]] = {static_cast<int>(batches_.size()) - 1, lane};
            batch.offset[lane] = own;
            batch.diagonal[lane] = Scalar(star.diagonal);
            for (int t = 0; t < batch.count; ++t) {
                const bool is_tet = t < static_cast<int>(star.tets.size()) && star.diagonal > 0.0;
                VertexIncidence<Scalar>& incidence = incidences_[batch.first + t];
                for (int k = 0; k < 3; ++k)
                    incidence.other[k][lane] = is_tet ? 4u * this->place_[star.tets[t].other[k]] : own;
                for (int k = 0; k < 3; ++k) incidence.w[k][lane] = is_tet ? Scalar(star.tets[t].w[k]) : Scalar(0);
                incidence.kappa[lane] = is_tet ? Scalar(star.tets[t].kappa) : Scalar(0);
                incidence.d[lane] = is_tet ? Scalar(star.tets[t].d) : Scalar(0);
            }
        }
    }

    Parallel parallel_;
    std::vector<std::pair<int, int>> lane_of_;  // the batch and the lane of each vertex, #V
    std::vector<std::vector<Chunk>> colours_;
    std::vector<VertexBatch<Scalar>> batches_;
    std::vector<VertexIncidence<Scalar>> incidences_;
    Rows<Scalar> centres_;  // c_i - origin, a_i
};

}  // namespace

std::vector<double> chebyshev_weights(double rho, int count)
{
    std::vector<double> weights;
    for (int k = 1; k <= count; ++k)
        weights.push_back(k == 1 ? 1.0 : k == 2 ? 2.0 / (2.0 - rho * rho) : 4.0 / (4.0 - rho * rho * weights.back()));
    return weights;
}

template <typename Scalar>
VertexBlockDescent<Scalar>::VertexBlockDescent(const TetMesh& mesh, const FleshEnergy& energy,
                                               const VertexBlockOptions& options)
    : options_(checked(options)),
      sweep_(make_vertex_sweep<Scalar>(mesh, energy, options.packed, options.threads)),
      x_(sweep_->rows())
{
    if (options.contact) contact_.emplace(mesh, energy, sweep_->place());
    if (options.acceleration == Acceleration::chebyshev) weights_ = chebyshev_weights(options.rho, options.iterations);
}

template <typename Scalar>
VertexBlockSummary VertexBlockDescent<Scalar>::minimise(const Positions& centres, Positions& x)
{
    sweep_->set_centres(centres);
    sweep_->load(x, x_);
    if (options_.acceleration == Acceleration::chebyshev) {
        before_ = x_;
        for (int k = 0; k < options_.iterations; ++k) {
            before_that_ = before_;
            before_ = x_;
            sweep(k, 1.0);
            if (weights_[k] != 1.0) sweep_->extrapolate(weights_[k], before_that_, x_);
        }
    } else {
        for (int k = 0; k < options_.iterations; ++k) sweep(k, options_.omega);
    }
    sweep_->store(x_, x);
    return {options_.iterations, x.allFinite()};
}

// Contacts are sought at the beginning and after half of the sweeps. In a sweep, the springs of ContactPull stand for
// their energy: where the sweep lowers the sum of flesh and springs, it lowers the sum of flesh and contact. A spring
// of stiffness A and gradient g at x_i and the hold of a vertex make one spring, of stiffness a_i + A and centre (a_i
// c_i + A x_i - g) / (a_i + A).
template <typename Scalar>
void VertexBlockDescent<Scalar>::sweep(int iteration, double omega)
{
    if (contact_ && iteration == 0) contact_->forget();
    if (contact_ && (iteration == 0 || iteration == options_.iterations / 2)) contact_->find(x_);
    std::vector<std::pair<int, VertexHold>> own;
    if (contact_)
        for (const ContactPull& pull : contact_->pulls(x_)) {
            const VertexHold hold = sweep_->hold(pull.vertex);
            const Scalar* p = x_[sweep_->place()[pull.vertex]];
            const Vec3 x(p[0], p[1], p[2]);
            const double stiffness = hold.stiffness + pull.stiffness;
            if (!(stiffness > 0.0)) continue;
            own.emplace_back(pull.vertex, hold);
            sweep_->set_hold(pull.vertex,
                             {(hold.stiffness * hold.centre + pull.stiffness * x - pull.gradient) / stiffness,
                              stiffness, hold.diagonal + pull.stiffness});
        }
    sweep_->move(omega, x_);
    for (const auto& [vertex, hold] : own) sweep_->set_hold(vertex, hold);
}

template class VertexBlockDescent<float>;
template class VertexBlockDescent<double>;

std::vector<VertexStar> vertex_stars(const FleshEnergy& energy)
{
    std::vector<VertexStar> stars(energy.hold().size());
    for (std::size_t i = 0; i < stars.size(); ++i) stars[i].hold = stars[i].diagonal = energy.hold()(i);
    for (const FleshTet& tet : energy.tets())
        for (int corner = 0; corner < 4; ++corner) {
            IncidentTet incident{{}, {}, tet.kappa, tet.d};
            VertexStar& star = stars[tet.vertex[corner]];
            for (int k = 0; k < 3; ++k) {
                const int other = others_of_corner[corner][k];
                incident.other[k] = tet.vertex[other];
                incident.w[k] = tet.w[edge_between[corner][other]];
                star.diagonal += incident.w[k];
            }
            star.tets.push_back(incident);
        }
    return stars;
}

VertexBlock vertex_block(const VertexStar& star, int vertex, const Positions& x, const Positions& centres)
{
    const Vec3 x_i = x.row(vertex);
    VertexBlock block{star.hold * (x_i - centres.row(vertex).transpose()), star.diagonal * Eigen::Matrix3d::Identity(),
                      star.diagonal};
    for (const IncidentTet& tet : star.tets) {
        Vec3 to[3];
        for (int k = 0; k < 3; ++k) {
            to[k] = x.row(tet.other[k]).transpose() - x_i;
            block.gradient -= tet.w[k] * to[k];
        }
        const Vec3 n = (to[1] - to[0]).cross(to[2] - to[0]);
        const double six_volumes = -n.dot(to[0]);
        block.gradient += tet.kappa * (six_volumes - tet.d) * n;
        block.hessian += tet.kappa * n * n.transpose();
    }
    return block;
}

Vec3 block_step(const VertexBlock& block)
{
    if (!(block.diagonal > 0.0)) return Vec3::Zero();
    const Eigen::Matrix3d& h = block.hessian;
    const Vec3& g = block.gradient;
    const double d0 = h(0, 0), l10 = h(1, 0) / d0, l20 = h(2, 0) / d0;
    const double d1 = std::max(h(1, 1) - l10 * h(1, 0), block.diagonal);
    const double below = h(2, 1) - l20 * h(1, 0), l21 = below / d1;
    const double d2 = std::max(h(2, 2) - l20 * h(2, 0) - l21 * below, block.diagonal);
    const double y1 = g(1) - l10 * g(0), y2 = g(2) - l20 * g(0) - l21 * y1;
    const double s2 = y2 / d2, s1 = y1 / d1 - l21 * s2, s0 = g(0) / d0 - l10 * s1 - l20 * s2;
    return {s0, s1, s2};
}

template <typename Scalar>
std::unique_ptr<VertexSweep<Scalar>> make_vertex_sweep(const TetMesh& mesh, const FleshEnergy& energy, bool packed,
                                                       int threads)
{
    if constexpr (std::is_same_v<Scalar, double>)
        if (!packed) return std::make_unique<PlainVertexSweep>(mesh, energy);
    return std::make_unique<PackedVertexSweep<Scalar>>(mesh, energy, threads);
}

template std::unique_ptr<VertexSweep<float>> make_vertex_sweep(const TetMesh&, const FleshEnergy&, bool, int);
template std::unique_ptr<VertexSweep<double>> make_vertex_sweep(const TetMesh&, const FleshEnergy&, bool, int);

}  // namespace pbs
