#include "geometry/packing/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {

namespace {

constexpr int k_layers = 50, k_places = 200;
constexpr double k_rounded_off = 0.01;  // of a region

/// A region's cross-section and ends.
struct Prism {
    double bottom = 0.0, top = 0.0, area = 0.0;
    std::vector<Eigen::Vector2d> places;  // spread evenly over the cross-section
};

/// Numbers of the additive recurrence of the plastic number, in [0, 1)^2.
Eigen::Vector2d spread_evenly(int n) {
    constexpr double plastic = 1.32471795724474602596;
    const Eigen::Vector2d sum = Eigen::Vector2d::Constant(0.5) + n * Eigen::Vector2d(1.0 / plastic, 1.0 / (plastic * plastic));
    return sum.array() - sum.array().floor();
}

Prism prism_of(const Region& region) {
    Prism prism;
    const auto* box = std::get_if<BoxRegion>(&region);
    for (int n = 0; n < k_places; ++n) {
        const Eigen::Vector2d share = spread_evenly(n);
        if (box != nullptr) {
            prism.places.emplace_back(box->lower.head<2>() + share.cwiseProduct((box->upper - box->lower).head<2>()));
            continue;
        }
        const auto& cylinder = std::get<CylinderRegion>(region);
        const double angle = 2.0 * k_pi * share.y();
        prism.places.emplace_back(cylinder.from.head<2>() +
                                  cylinder.radius * std::sqrt(share.x()) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (box != nullptr) {
        const Vec3 size = box->upper - box->lower;
        prism.bottom = box->lower.z(), prism.top = box->upper.z(), prism.area = size.x() * size.y();
    } else {
        const auto& cylinder = std::get<CylinderRegion>(region);
        prism.bottom = cylinder.from.z(), prism.top = cylinder.to.z(), prism.area = k_pi * cylinder.radius * cylinder.radius;
    }
    return prism;
}

double free_share(const Prism& prism, double level, const std::vector<SolidSearch>& solids) {
    const auto taken = std::count_if(prism.places.begin(), prism.places.end(), [&](const Eigen::Vector2d& place) {
        const Vec3 point(place.x(), place.y(), level);
        return std::any_of(solids.begin(), solids.end(), [&](const SolidSearch& solid) { return solid.contains(point); });
    });
    return 1.0 - static_cast<double>(taken) / k_places;
}

}  // namespace

FreeSpace::FreeSpace(const Region& region, const std::vector<SolidSearch>& solids) {
    const Prism prism = prism_of(region);
    top_ = prism.top;
    const double height = (prism.top - prism.bottom) / k_layers;
    double below = 0.0;
    for (int n = 0; n < k_layers; ++n) {
        const double from = prism.bottom + n * height, area = prism.area * free_share(prism, from + 0.5 * height, solids);
        layers_.push_back({from, area, below});
        below += area * height;
    }
    if (below > (1.0 - k_rounded_off) * prism.area * (prism.top - prism.bottom)) layers_ = {{prism.bottom, prism.area, 0.0}};
}

double FreeSpace::volume_below(double level) const {
    const double within = std::clamp(level, layers_.front().from, top_);
    const auto above =
        std::upper_bound(layers_.begin() + 1, layers_.end(), within, [](double value, const Layer& layer) { return value < layer.from; });
    const Layer& layer = *std::prev(above);
    return layer.below + layer.area * (within - layer.from);
}

double FreeSpace::level_of(double volume) const {
    for (auto layer = layers_.begin(); layer != layers_.end(); ++layer) {
        const bool last = std::next(layer) == layers_.end();
        const double room = (last ? this->volume() : std::next(layer)->below) - layer->below;
        if (room > 0.0 && volume <= layer->below + room) return layer->from + std::max(0.0, volume - layer->below) / layer->area;
    }
    return top_;
}

}  // namespace cutterflow::geometry
