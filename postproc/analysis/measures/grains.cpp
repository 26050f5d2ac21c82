#include "postproc/analysis/measures/grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/sphere.hpp"

namespace cutterflow::postproc {

namespace {

Vec3 vector_of(const nlohmann::json& value) {
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

/// Points of a lattice across the diameter of the unit sphere; even, so that none lies on a plane through the centre.
constexpr int k_lattice = 10;

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace

void Grains::add(const Vec3& place, const Vec3& speed, double size, double mass_density) {
    position.push_back(place);
    velocity.push_back(speed);
    diameter.push_back(size);
    density.push_back(mass_density);
}

Region region_of(const nlohmann::json& value) {
    const std::string& kind = value.begin().key();
    const nlohmann::json& numbers = *value.begin();
    if (kind == "box") return BoxRegion{vector_of(numbers["lower_m"]), vector_of(numbers["upper_m"])};
    if (kind == "sphere") return SphereRegion{vector_of(numbers["centre_m"]), numbers["radius_m"].get<double>()};
    if (kind == "cylinder")
        return CylinderRegion{vector_of(numbers["from_m"]), vector_of(numbers["to_m"]), numbers["radius_m"].get<double>()};
    return HalfSpaceRegion{vector_of(numbers["point_m"]), vector_of(numbers["normal"])};
}

double volume_of(const Region& region) {
    return std::visit(Overloaded{[](const BoxRegion& box) { return (box.upper - box.lower).prod(); },
                                 [](const SphereRegion& sphere) { return sphere_volume(2.0 * sphere.radius); },
                                 [](const CylinderRegion& cylinder) {
                                     return k_pi * cylinder.radius * cylinder.radius * (cylinder.to - cylinder.from).norm();
                                 },
                                 [](const auto&) { return std::numeric_limits<double>::infinity(); }},
                      region);
}

Grains grains_in(const Grains& grains, const Region& region) {
    Grains inside;
    for (std::size_t i = 0; i < grains.size(); ++i)
        if (is_within(region, grains.position[i]))
            inside.add(grains.position[i], grains.velocity[i], grains.diameter[i], grains.density[i]);
    return inside;
}

double mean_diameter(const Grains& grains) {
    double sum = 0.0;
    for (const double diameter : grains.diameter) sum += diameter;
    return grains.size() == 0 ? 0.0 : sum / static_cast<double>(grains.size());
}

double mass_of(const Grains& grains) {
    double sum = 0.0;
    for (std::size_t i = 0; i < grains.size(); ++i) sum += sphere_mass(grains.diameter[i], grains.density[i]);
    return sum;
}

std::pair<Vec3, Vec3> bounds_of(const Grains& grains) {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
    for (std::size_t i = 0; i < grains.size(); ++i) {
        lower = lower.cwiseMin(grains.position[i] - Vec3::Constant(0.5 * grains.diameter[i]));
        upper = upper.cwiseMax(grains.position[i] + Vec3::Constant(0.5 * grains.diameter[i]));
    }
    return {lower, upper};
}

const std::vector<Vec3>& unit_sphere_points() {
    static const std::vector<Vec3> points = [] {
        std::vector<Vec3> inside;
        const auto place = [](int i) { return (2.0 * i + 1.0) / k_lattice - 1.0; };
        for (int i = 0; i < k_lattice; ++i)
            for (int j = 0; j < k_lattice; ++j)
                for (int k = 0; k < k_lattice; ++k) {
                    const Vec3 point(place(i), place(j), place(k));
                    if (point.norm() <= 1.0) inside.push_back(point);
                }
        return inside;
    }();
    return points;
}

double solid_share(const Grains& grains, const Region& region) {
    const std::vector<Vec3>& points = unit_sphere_points();
    double solid = 0.0;
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const auto inside = std::count_if(points.begin(), points.end(), [&](const Vec3& point) {
            return is_within(region, grains.position[i] + 0.5 * grains.diameter[i] * point);
        });
        solid += sphere_volume(grains.diameter[i]) * static_cast<double>(inside) / static_cast<double>(points.size());
    }
    return solid / volume_of(region);
}

}  // namespace cutterflow::postproc
