#pragma once
/// \file Union and difference of solids with exact arithmetic.
#include <memory>

#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// A solid bounded by a closed surface, in exact coordinates: a sequence of unions and differences loses nothing to
/// rounding.
class ExactSolid {
public:
    /// \param surface  closed, outward oriented, without self-intersection
    /// \throws CheckFailure  when the triangles do not form a closed 2-manifold
    explicit ExactSolid(const TriangleSurface& surface);
    ~ExactSolid();

    /// \throws CheckFailure  when the result is no 2-manifold (solids that touch along an edge or a point only)
    void unite(const ExactSolid& other);

    /// Takes the other solid's room away. \throws CheckFailure  as unite
    void subtract(const ExactSolid& other);

    /// Coordinates rounded to double precision.
    TriangleSurface surface() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cutterflow::geometry
