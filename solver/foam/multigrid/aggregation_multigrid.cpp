#include "solver/foam/multigrid/aggregation_multigrid.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "solver/foam/multigrid/level_couplings.hpp"
#include "solver/foam/multigrid/level_matrix.hpp"
#include "solver/foam/session/pstream_communicator.hpp"

#include "MeshObject.H"
#include "addToRunTimeSelectionTable.H"
#include "fvMesh.H"
#include "lduMatrix.H"
#include "surfaceFields.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

constexpr int k_passes = 3;          // eight cells a cluster
constexpr label k_last_level = 300;  // clusters of all ranks that are solved exactly

FaceGraph graph_of(const lduAddressing& mesh) {
    FaceGraph graph;
    graph.cells = mesh.size();
    graph.lower.assign(mesh.lowerAddr().begin(), mesh.lowerAddr().end());
    graph.upper.assign(mesh.upperAddr().begin(), mesh.upperAddr().end());
    return graph;
}

/// Area over distance of the faces within the mesh [m].
std::vector<double> strength_of(const fvMesh& mesh) {
    const scalarField strength(mesh.magSf().primitiveField() * mesh.nonOrthDeltaCoeffs().primitiveField());
    return {strength.begin(), strength.end()};
}

/// Clusters of a mesh, level by level. All ranks have as many levels.
class ClusterLevels : public MeshObject<fvMesh, TopologicalMeshObject, ClusterLevels> {
public:
    TypeName("aggregationMultigridClusters");

    explicit ClusterLevels(const fvMesh& mesh) : MeshObject<fvMesh, TopologicalMeshObject, ClusterLevels>(mesh) {
        graphs_.push_back(graph_of(mesh.lduAddr()));
        std::vector<double> strength = strength_of(mesh);
        label cells = returnReduce(label(graphs_.back().cells), sumOp<label>());
        for (label before = 2 * cells; cells > k_last_level && cells < before;) {
            clusters_.push_back(cluster(graphs_.back(), strength, k_passes));
            strength = gather_strength(clusters_.back(), strength);
            graphs_.push_back(clusters_.back().graph);
            before = cells;
            cells = returnReduce(label(graphs_.back().cells), sumOp<label>());
        }
        layouts_.reserve(graphs_.size());
        for (const FaceGraph& graph : graphs_) layouts_.emplace_back(graph);
    }

    std::size_t size() const { return graphs_.size(); }
    const FaceGraph& graph(std::size_t level) const { return graphs_[level]; }
    /// From a level to the next.
    const Clusters& clusters(std::size_t level) const { return clusters_[level]; }
    const RowLayout& layout(std::size_t level) const { return layouts_[level]; }

private:
    std::vector<FaceGraph> graphs_;
    std::vector<Clusters> clusters_;
    std::vector<RowLayout> layouts_;
};

defineTypeNameAndDebug(ClusterLevels, 0);

/// The matrix of all ranks' clusters, factorised on every rank.
class LastLevel {
public:
    LastLevel() = default;
    /// Collective.
    LastLevel(const globalIndex& clusters, const FaceGraph& graph, const FaceMatrix& matrix, const std::vector<PatchElement>& couplings)
        : first_(clusters.toGlobal(0)), own_(graph.cells), right_side_(clusters.size()) {
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(clusters.size(), clusters.size());
        for (int row = 0; row < own_; ++row) dense(first_ + row, first_ + row) = matrix.diagonal[static_cast<std::size_t>(row)];
        for (std::size_t face = 0; face < graph.faces(); ++face) {
            const int lower = first_ + graph.lower[face], upper = first_ + graph.upper[face];
            dense(lower, upper) += matrix.coupling[face];
            dense(upper, lower) += matrix.coupling[face];
        }
        // A sliding interface gives the two elements of a pair different values. Their mean, with rows that add up to what they did, leaves
        // the matrix definite, in a closed domain too.
        for (const PatchElement& element : couplings) {
            const int row = first_ + element.row;
            const double half = 0.5 * element.value;
            dense(row, element.column) += half;
            dense(element.column, row) += half;
            dense(row, row) += half;
            dense(element.column, element.column) -= half;
        }
        ranks_.sum({dense.data(), static_cast<std::size_t>(dense.size())});
        sign_ = dense.trace() < 0.0 ? -1.0 : 1.0;  // OpenFOAM's Laplacian is negative
        factor_.compute(sign_ * dense);
    }

    /// Collective.
    void solve(const std::vector<float>& b, std::vector<float>& x) {
        right_side_.setZero();
        for (int row = 0; row < own_; ++row) right_side_[first_ + row] = sign_ * static_cast<double>(b[static_cast<std::size_t>(row)]);
        ranks_.sum({right_side_.data(), static_cast<std::size_t>(right_side_.size())});
        factor_.solveInPlace(right_side_);
        for (int row = 0; row < own_; ++row) x[static_cast<std::size_t>(row)] = static_cast<float>(right_side_[first_ + row]);
    }

private:
    int first_ = 0, own_ = 0;
    double sign_ = 1.0;
    Eigen::VectorXd right_side_;
    Eigen::LLT<Eigen::MatrixXd> factor_;
    PstreamCommunicator ranks_;
};

class AggregationMultigrid : public lduMatrix::preconditioner {
public:
    TypeName("aggregationMultigrid");

    AggregationMultigrid(const lduMatrix::solver& solver, const dictionary&)
        : lduMatrix::preconditioner(solver), clusters_(ClusterLevels::New(refCast<const fvMesh>(solver.matrix().mesh()))) {
        const scalarField &diagonal = solver.matrix().diag(), &coupling = solver.matrix().upper();
        FaceMatrix matrix{{diagonal.begin(), diagonal.end()}, {coupling.begin(), coupling.end()}};
        globalIndex rows(clusters_.graph(0).cells);
        std::vector<PatchElement> elements = patch_elements(solver, rows);
        levels_.reserve(clusters_.size() - 1);
        for (std::size_t level = 0; level + 1 < clusters_.size(); ++level) {
            levels_.emplace_back(clusters_.layout(level), matrix, LevelCouplings(rows, elements));
            const Clusters& clusters = clusters_.clusters(level);
            FaceMatrix of_clusters;
            clusters.gather(clusters_.graph(level), matrix, of_clusters);
            matrix = std::move(of_clusters);
            rows = globalIndex(clusters.graph.cells);
            elements = gather(levels_.back().couplings, clusters, rows.toGlobal(0));
        }
        last_level_ = LastLevel(rows, clusters_.graph(clusters_.size() - 1), matrix, elements);
        last_b_.resize(static_cast<std::size_t>(rows.localSize()));
        last_x_.resize(last_b_.size());
    }

    /// w = M^-1 r.
    void precondition(scalarField& w, const scalarField& r, const direction = 0) const override {
        std::vector<float>& b = right_side(0);
        const std::vector<float>& x = solution(0);
        for (std::size_t cell = 0; cell < b.size(); ++cell) b[cell] = static_cast<float>(r[static_cast<label>(cell)]);
        is_last(0) ? last_level_.solve(last_b_, last_x_) : cycle(0);
        for (std::size_t cell = 0; cell < x.size(); ++cell) w[static_cast<label>(cell)] = static_cast<scalar>(x[cell]);
    }

private:
    struct Level {
        Level(const RowLayout& layout, const FaceMatrix& values, LevelCouplings across)
            : matrix(layout, values),
              couplings(std::move(across)),
              b(layout.rows()),
              x(b.size()),
              r(b.size()),
              rest(b.size()),
              first(b.size()) {}
        LevelMatrix matrix;
        LevelCouplings couplings;
        std::vector<float> b, x, r;
        std::vector<float> rest, first;  ///< of a level that is gone through twice
    };

    static std::vector<PatchElement> gather(const LevelCouplings& couplings, const Clusters& clusters, int first) {
        std::vector<int> numbers(clusters.of_cells);
        for (int& number : numbers) number += first;
        return couplings.gather(numbers, first);
    }

    bool is_last(std::size_t number) const { return number == levels_.size(); }
    std::vector<float>& right_side(std::size_t number) const { return is_last(number) ? last_b_ : levels_[number].b; }
    const std::vector<float>& solution(std::size_t number) const { return is_last(number) ? last_x_ : levels_[number].x; }

    /// x of a level from its b, which it uses up.
    void cycle(std::size_t number) const {
        Level& level = levels_[number];
        level.matrix.sweep_forward(level.b, level.x, level.r);
        level.couplings.subtract(level.x, level.r);

        const std::size_t next = number + 1;
        std::vector<float>& of_clusters = right_side(next);
        const std::vector<float>& correction = solution(next);
        const std::vector<int>& cluster = clusters_.clusters(number).of_cells;
        std::fill(of_clusters.begin(), of_clusters.end(), 0.0F);
        for (std::size_t cell = 0; cell < cluster.size(); ++cell) of_clusters[static_cast<std::size_t>(cluster[cell])] += level.r[cell];
        is_last(next) ? last_level_.solve(last_b_, last_x_) : cycle_twice(next);
        for (std::size_t cell = 0; cell < cluster.size(); ++cell) level.x[cell] += correction[static_cast<std::size_t>(cluster[cell])];

        level.couplings.subtract(level.x, level.b);
        level.matrix.sweep_backward(level.b, level.x);
    }

    void cycle_twice(std::size_t number) const {
        Level& level = levels_[number];
        level.rest = level.b;
        cycle(number);
        level.first = level.x;
        level.matrix.subtract(level.first, level.rest);
        level.couplings.subtract(level.first, level.rest);
        level.b.swap(level.rest);
        cycle(number);
        for (std::size_t cell = 0; cell < level.x.size(); ++cell) level.x[cell] += level.first[cell];
    }

    const ClusterLevels& clusters_;
    mutable std::vector<Level> levels_;
    mutable LastLevel last_level_;
    mutable std::vector<float> last_b_, last_x_;
};

defineTypeNameAndDebug(AggregationMultigrid, 0);
const lduMatrix::preconditioner::addsymMatrixConstructorToTable<AggregationMultigrid> k_selectable;

}  // namespace

dictionary own_linear_solver(const dictionary& section) {
    dictionary own(section);
    const word key = "cutterFoamPreconditioner";
    if (section.found(key)) own.set("preconditioner", word(section.lookup(key)));
    return own;
}

}  // namespace cutterflow::foam
