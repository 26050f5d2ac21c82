#include "solver/observe/gate_crossings.hpp"

namespace cutterflow::coupling {
namespace {

/// A point of the gate's plane.
Vec3 point_of(const GateSettings& gate) {
    return gate.rectangle ? gate.rectangle->lower : gate.centre;
}

/// Across the gate; of a rectangle along the direction in which it is flat, in the sense of its normal.
Vec3 normal_of(const GateSettings& gate) {
    if (!gate.rectangle) return gate.normal.normalized();
    for (Eigen::Index i = 0; i < 3; ++i)
        if (gate.rectangle->lower[i] == gate.rectangle->upper[i]) return gate.normal[i] < 0.0 ? Vec3(-Vec3::Unit(i)) : Vec3(Vec3::Unit(i));
    return gate.normal.normalized();
}

/// Whether a point of the plane belongs to the gate. \param across  its normal
bool covers(const GateSettings& gate, const Vec3& across, const Vec3& point) {
    if (!gate.rectangle) return (point - gate.centre).norm() <= gate.radius;
    const auto along = across.array().abs() < 0.5;  // not across
    return (!along || (point.array() >= gate.rectangle->lower.array() && point.array() <= gate.rectangle->upper.array())).all();
}

}  // namespace

std::vector<GateCrossing> crossings(const std::vector<GateSettings>& gates, const Vec3& before, const Vec3& after) {
    std::vector<GateCrossing> found;
    for (std::size_t k = 0; k < gates.size(); ++k) {
        const Vec3 normal = normal_of(gates[k]), point = point_of(gates[k]);
        const double from = normal.dot(before - point), to = normal.dot(after - point);
        if ((from > 0.0) == (to > 0.0)) continue;
        const double share = from / (from - to);
        const Vec3 place = before + share * (after - before);
        if (covers(gates[k], normal, place)) found.push_back({k, to > from ? 1 : -1, share, place});
    }
    return found;
}

}  // namespace cutterflow::coupling
