#include "solver/foam/single_phase/velocity_sampler.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <gsl/assert>
#include <nanoflann.hpp>

#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/single_phase/fields.hpp"

#include "fvcGrad.H"

namespace cutterflow::foam {

/// A cell that may hold a point. Cells that hold it come before all others, then the nearer centre counts.
struct VelocitySampler::Candidate {
    Foam::label cell = -1;
    double distance = std::numeric_limits<double>::max();  // to the cell's centre [m], less k_inside when the point lies in the cell
};

namespace {

constexpr std::size_t k_neighbours = 8;  // centres that are tried for holding a point
constexpr double k_inside = 1e9;         // [m], larger than any distance

struct CentreCloud {
    std::vector<Vec3> centres;
    std::vector<Foam::label> cells;
    std::size_t kdtree_get_point_count() const { return centres.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return centres[i][static_cast<Eigen::Index>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

}  // namespace

class VelocitySampler::ZoneTree {
public:
    ZoneTree(const coupling::Cells& cells, coupling::Zone zone) : cloud_(collect(cells, zone)), tree_(3, cloud_) { tree_.buildIndex(); }

    /// Cells with the nearest centres, nearest first; `point` in the zone's frame.
    std::size_t nearest(const Vec3& point, std::array<Foam::label, k_neighbours>& cells, std::array<double, k_neighbours>& distance) const {
        std::array<std::size_t, k_neighbours> index;
        std::array<double, k_neighbours> squared;
        const std::size_t found = cloud_.centres.empty() ? 0 : tree_.knnSearch(point.data(), k_neighbours, index.data(), squared.data());
        for (std::size_t i = 0; i < found; ++i) {
            cells[i] = cloud_.cells[index[i]];
            distance[i] = std::sqrt(squared[i]);
        }
        return found;
    }

private:
    static CentreCloud collect(const coupling::Cells& cells, coupling::Zone zone) {
        CentreCloud cloud;
        for (std::size_t i = 0; i < cells.centres.size(); ++i) {
            if (cells.zone[i] != zone) continue;
            cloud.centres.push_back(cells.centres[i]);
            cloud.cells.push_back(static_cast<Foam::label>(i));
        }
        return cloud;
    }

    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CentreCloud>, CentreCloud, 3, std::size_t>;
    CentreCloud cloud_;
    Tree tree_;
};

VelocitySampler::VelocitySampler(Foam::fvMesh& mesh, const coupling::Cells& cells, gsl::span<const coupling::ZoneMotion> moving)
    : mesh_(mesh), cells_(cells), moving_(moving.begin(), moving.end()) {
    for (coupling::Zone zone = 0; zone <= moving_.size(); ++zone) trees_.push_back(std::make_unique<ZoneTree>(cells, zone));
}

VelocitySampler::~VelocitySampler() = default;

VelocitySampler::Candidate VelocitySampler::find_cell(const Vec3& point, double time, Given given) const {
    Candidate best;
    // Moving zones first: of two cells that are equally near the first counts.
    for (coupling::Zone zone = trees_.size(); zone-- > 0;) {
        Vec3 there = point, where = point;  // in the zone's frame, at present
        if (zone != coupling::k_still_zone) {
            const coupling::ZoneMotion& motion = moving_[zone - 1];
            if (given == Given::at_present)
                there = rotate_about(motion.axis, -motion.angle(time), point);
            else
                where = rotate_about(motion.axis, motion.angle(time), point);
        }
        std::array<Foam::label, k_neighbours> cells;
        std::array<double, k_neighbours> distance;
        const std::size_t found = trees_[zone]->nearest(there, cells, distance);
        for (std::size_t i = 0; i < found; ++i) {
            const bool inside = mesh_.pointInCell(to_foam(where), cells[i], Foam::polyMesh::FACE_PLANES);
            const double rank = inside ? distance[i] - k_inside : distance[i];
            if (rank < best.distance) best = {cells[i], rank};
        }
    }
    return best;
}

/// The cell of each point, -1 where another rank's cell holds it or is nearer. Several ranks may be equally near: the lowest one answers.
std::vector<Foam::label> VelocitySampler::own_cells(gsl::span<const Vec3> points, double time, Given given,
                                                    coupling::Communicator& communicator) const {
    std::vector<Candidate> candidates(points.size());
    std::vector<double> nearest(points.size()), speaker(points.size());
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        candidates[i] = find_cell(points[i], time, given);
        nearest[i] = -candidates[i].distance;
    }
    communicator.max(nearest);
    for (std::size_t i = 0; i < candidates.size(); ++i) speaker[i] = -candidates[i].distance == nearest[i] ? -communicator.rank() : -1e9;
    communicator.max(speaker);
    std::vector<Foam::label> cells(points.size(), -1);
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (speaker[i] == -communicator.rank()) cells[i] = candidates[i].cell;
    return cells;
}

void VelocitySampler::sample(const Foam::volVectorField& velocity, double time, coupling::Communicator& communicator,
                             gsl::span<const Vec3> points, gsl::span<Vec3> result) const {
    const KeptGradients gradients(mesh_);
    const Foam::tmp<Foam::volTensorField> gradient = Foam::fvc::grad(velocity);
    const std::vector<Foam::label> cells = own_cells(points, time, Given::at_present, communicator);
    std::vector<double> values(3 * points.size(), 0.0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Foam::label cell = cells[i];
        if (cell < 0) continue;
        const Foam::vector at_point = velocity[cell] + ((to_foam(points[i]) - mesh_.C()[cell]) & gradient()[cell]);
        for (Foam::direction component = 0; component < 3; ++component) values[3 * i + component] = at_point[component];
    }
    communicator.sum(values);
    for (std::size_t i = 0; i < cells.size(); ++i) result[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
}

void VelocitySampler::watch(const coupling::WatchedPlaces& places, double time, coupling::Communicator& communicator) {
    Expects(places.groups > 0 && places.points.size() % places.groups == 0 && places.points.size() == places.directions.size());
    groups_ = places.groups;
    per_group_ = places.points.size() / places.groups;
    const std::vector<Foam::label> cells = own_cells(places.points, time, Given::at_start, communicator);
    places_.clear();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] < 0) continue;
        const Vec3& centre = cells_.centres[static_cast<std::size_t>(cells[i])];
        places_.push_back({cells[i], places.points[i] - centre, places.directions[i], i / per_group_});
    }
}

std::vector<double> VelocitySampler::watched_means(const Foam::volVectorField& velocity, double time,
                                                   coupling::Communicator& communicator) const {
    const KeptGradients gradients(mesh_);
    const Foam::tmp<Foam::volTensorField> gradient = Foam::fvc::grad(velocity);
    std::vector<Eigen::Matrix3d> turns;  // of the zones since time 0
    for (const coupling::ZoneMotion& motion : moving_)
        turns.push_back(Eigen::AngleAxisd(motion.angle(time), motion.axis.direction).toRotationMatrix());
    std::vector<double> means(groups_, 0.0);
    for (const Place& place : places_) {
        Vec3 offset = place.offset, direction = place.direction;
        const coupling::Zone zone = cells_.zone[static_cast<std::size_t>(place.cell)];
        if (zone != coupling::k_still_zone) {
            offset = turns[zone - 1] * offset;
            direction = turns[zone - 1] * direction;
        }
        const Vec3 carried = to_vec3(to_foam(offset) & gradient()[place.cell]);
        means[place.group] += (to_vec3(velocity[place.cell]) + carried).dot(direction) / static_cast<double>(per_group_);
    }
    communicator.sum(means);
    return means;
}

}  // namespace cutterflow::foam
