#include "solver/free_surface/cut_cells/covered_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cutterflow::free_surface {

Interval common(const Interval& a, const Interval& b) {
    return {std::max(a.from, b.from), std::min(a.to, b.to)};
}

double union_length(std::vector<Interval> intervals) {
    std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.from < b.from; });
    double length = 0.0, reached = intervals.empty() ? 0.0 : intervals.front().from;
    for (const Interval& interval : intervals) {
        const double from = std::max(reached, interval.from);
        length += std::max(0.0, interval.to - from);
        reached = std::max(reached, interval.to);
    }
    return length;
}

Interval chord(double distance, double centre, double radius) {
    const double square = radius * radius - distance * distance;
    if (square <= 0.0) return {centre, centre};
    const double half = std::sqrt(square);
    return {centre - half, centre + half};
}

namespace {

/// Half the chord of a disc at a distance a from its centre, and its integral from 0 to a.
struct HalfChord {
    double radius;
    double value(double a) const { return std::sqrt(std::max(0.0, radius * radius - a * a)); }
    double integral(double a) const { return 0.5 * (a * value(a) + radius * radius * std::asin(std::clamp(a / radius, -1.0, 1.0))); }
};

/// Where the character of the figure changes along a, in order.
std::vector<double> breaks(double radius, const Interval& a, const Interval& b) {
    std::vector<double> places{a.from, a.to};
    for (const double line : {b.from, b.to}) {
        if (std::abs(line) >= radius) continue;
        const double place = std::sqrt(radius * radius - line * line);
        for (const double at : {-place, place}) {
            if (at > a.from && at < a.to) places.push_back(at);
        }
    }
    std::sort(places.begin(), places.end());
    return places;
}

/// Abscissae and weights of Gauss' formula of ten points on (-1, 1), one side. [AbramowitzStegun1964]
constexpr std::array<std::array<double, 2>, 5> k_gauss{{{0.1488743389816312, 0.2955242247147529},
                                                        {0.4333953941292472, 0.2692667193099963},
                                                        {0.6794095682990244, 0.2190863625159820},
                                                        {0.8650633666889845, 0.1494513491505806},
                                                        {0.9739065285171717, 0.0666713443086881}}};

}  // namespace

double disc_in_rectangle(double radius, const Interval& a, const Interval& b) {
    const Interval within = common(a, {-radius, radius});
    if (within.length() <= 0.0) return 0.0;
    const HalfChord half{radius};
    const std::vector<double> places = breaks(radius, within, b);
    double area = 0.0;
    for (std::size_t n = 0; n + 1 < places.size(); ++n) {
        const Interval part{places[n], places[n + 1]};
        const double edge = half.value(part.middle()), under_edge = half.integral(part.to) - half.integral(part.from);
        if (std::min(b.to, edge) <= std::max(b.from, -edge)) continue;
        area += b.to < edge ? b.to * part.length() : under_edge;
        area -= b.from > -edge ? b.from * part.length() : -under_edge;
    }
    return area;
}

double sphere_in_box(double radius, const Interval& a, const Interval& b, const Interval& c) {
    const Interval within = common(c, {-radius, radius});
    if (within.length() <= 0.0) return 0.0;
    // The section's radius passes the rectangle's edges and corners at these places; between them the area is smooth.
    std::vector<double> places{within.from, within.to};
    const auto add = [&](double square) {
        if (square <= 0.0 || square >= radius * radius) return;
        const double place = std::sqrt(radius * radius - square);
        for (const double at : {-place, place}) {
            if (at > within.from && at < within.to) places.push_back(at);
        }
    };
    for (const double x : {a.from, a.to}) {
        add(x * x);
        for (const double y : {b.from, b.to}) add(x * x + y * y);
    }
    for (const double y : {b.from, b.to}) add(y * y);
    std::sort(places.begin(), places.end());
    double volume = 0.0;
    for (std::size_t n = 0; n + 1 < places.size(); ++n) {
        const double middle = 0.5 * (places[n] + places[n + 1]), half = 0.5 * (places[n + 1] - places[n]);
        for (const auto& [abscissa, weight] : k_gauss) {
            for (const double place : {middle - half * abscissa, middle + half * abscissa}) {
                volume += half * weight * disc_in_rectangle(std::sqrt(radius * radius - place * place), a, b);
            }
        }
    }
    return volume;
}

}  // namespace cutterflow::free_surface
