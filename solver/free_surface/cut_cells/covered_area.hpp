#pragma once
/// \file What solids cover of segments, rectangles and boxes: exact, pure functions.
#include <utility>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::free_surface {

/// A part of a line [m]; empty when to <= from.
struct Interval {
    double from = 0.0, to = 0.0;
    double length() const { return to > from ? to - from : 0.0; }
    double middle() const { return 0.5 * (from + to); }
};

Interval common(const Interval& a, const Interval& b);

/// Length [m] of a union of intervals.
double union_length(std::vector<Interval> intervals);

/// Chord of a disc of radius `radius` on a line that passes its centre at `distance`, the centre standing at `centre` along the line [m].
/// Empty when the line misses the disc.
Interval chord(double distance, double centre, double radius);

/// Area [m2] of the common part of a disc about the origin and the rectangle a x b: closed form.
double disc_in_rectangle(double radius, const Interval& a, const Interval& b);

/// Volume [m3] of the common part of a sphere about the origin and a box. Areas are exact, their integral over c is Gauss' with ten points
/// on each smooth part: relative error below 1e-6.
double sphere_in_box(double radius, const Interval& a, const Interval& b, const Interval& c);

}  // namespace cutterflow::free_surface
