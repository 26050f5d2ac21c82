#include "solver/space/open_share.hpp"

#include <algorithm>
#include <cmath>

#include "solver/space/swept_body.hpp"

namespace cutterflow::coupling {
namespace {

/// In sizes of the largest cell, from which on the surface does not matter to a cell.
constexpr double k_reach = 3.0;
constexpr std::uint64_t k_for_ever = ~std::uint64_t{0};

/// Around what the corners of the box around the centres sweep, which is more than the centres do. \param centres  in the zone's frame
Box box_around(const PointTree& centres, const RotationAxis& axis) {
    const Box bounds = centres.bounds();
    SweptBody body;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vec3 place;
        for (int i = 0; i < 3; ++i) place[i] = (corner >> i & 1u) != 0 ? bounds.upper[i] : bounds.lower[i];
        body.add(axis, place);
    }
    return body.box(axis);
}

/// About half the size of a cell that turns [m], in quarter octaves, so that the order of a sum does not matter; 0 when none turns.
/// Collective.
double grid_spacing(const Cells& cells, Communicator& communicator) {
    double sums[] = {0.0, 0.0};  // volume, count
    for (std::size_t c = 0; c < cells.centres.size(); ++c) {
        if (cells.zone[c] == k_still_zone) continue;
        sums[0] += cells.volumes[c];
        sums[1] += 1.0;
    }
    communicator.sum(sums);
    if (sums[1] == 0.0) return 0.0;
    return std::exp2(0.25 * std::round(4.0 * std::log2(0.5 * std::cbrt(sums[0] / sums[1]))));
}

}  // namespace

OpenShare::OpenShare(gsl::span<const SteelTriangle> soil, const CellTrees& trees, gsl::span<const ZoneMotion> moving,
                     const SizeField& sizes, const ZoneFrames& frames, Communicator& communicator)
    : trees_(trees), frames_(frames) {
    if (soil.empty()) return;
    surface_ = std::make_unique<SoilSurface>(std::vector<SteelTriangle>(soil.begin(), soil.end()));
    shares_.resize(trees.cells().centres.size());
    computed_at_.resize(shares_.size(), 0);
    make_grid(moving, grid_spacing(trees.cells(), communicator), k_reach * sizes.largest());
}

/// \param reach  [m], from which on distances do not matter
void OpenShare::make_grid(gsl::span<const ZoneMotion> moving, double spacing, double reach) {
    Box box;
    for (std::size_t i = 0; i < moving.size(); ++i)
        if (const PointTree& centres = trees_.of(static_cast<Zone>(i + 1)); centres.size() > 0)
            box.extend(box_around(centres, moving[i].axis));
    if ((box.lower.array() > box.upper.array()).any()) return;
    grid_ = std::make_unique<DistanceGrid>(box.lower, box.upper, spacing,
                                           [this, reach](const Vec3& point) { return surface_->distance(point, reach); });
}

void OpenShare::set_frames(const ZoneFrames& frames) {
    frames_ = frames;
    ++stamp_;
}

double OpenShare::at(std::int32_t place) {
    if (!surface_) return 1.0;
    const auto p = static_cast<std::size_t>(place);
    if (computed_at_[p] >= stamp_) return shares_[p];
    const auto cell = static_cast<std::size_t>(trees_.number(place));
    const auto zone = static_cast<Zone>(trees_.cells().zone[cell]);
    const double size = trees_.cells().sizes[cell];
    shares_[p] = std::clamp(2.0 * distance(zone, trees_.centre(place), size) / size, 0.0, 1.0);
    computed_at_[p] = zone == k_still_zone ? k_for_ever : stamp_;
    return shares_[p];
}

/// Of a centre in its zone's frame from the soil [m], below 0 in it.
double OpenShare::distance(Zone zone, const Vec3& centre, double size) {
    return zone == k_still_zone ? surface_->distance(centre, k_reach * size) : grid_->at(frames_.to_absolute(zone, centre));
}

}  // namespace cutterflow::coupling
