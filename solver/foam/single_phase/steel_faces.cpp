#include "solver/foam/single_phase/steel_faces.hpp"

#include "solver/foam/session/foam_conversions.hpp"

#include "ListListOps.H"
#include "Pstream.H"
#include "fvMesh.H"
#include "wallFvPatch.H"

namespace cutterflow::foam {
namespace {

/// Corners, three per triangle, of a face that is fanned out from its first point.
void append_triangles(const Foam::face& face, const Foam::pointField& points, Foam::DynamicList<Foam::point>& corners) {
    for (Foam::label i = 1; i + 1 < face.size(); ++i) {
        corners.append(points[face[0]]);
        corners.append(points[face[i]]);
        corners.append(points[face[i + 1]]);
    }
}

/// The lists of all ranks one after the other, on every rank.
std::vector<coupling::SteelTriangle> gather(const Foam::DynamicList<Foam::point>& corners) {
    Foam::List<Foam::pointField> of_ranks(Foam::Pstream::nProcs());
    of_ranks[Foam::Pstream::myProcNo()] = Foam::pointField(corners);
    Foam::Pstream::gatherList(of_ranks);
    Foam::Pstream::scatterList(of_ranks);
    std::vector<coupling::SteelTriangle> triangles;
    for (const Foam::pointField& all : of_ranks) {
        for (Foam::label i = 0; i + 2 < all.size(); i += 3)
            triangles.push_back({to_vec3(all[i]), to_vec3(all[i + 1]), to_vec3(all[i + 2])});
    }
    return triangles;
}

}  // namespace

SteelFaces gather_steel_faces(const Foam::fvMesh& mesh, gsl::span<const std::uint8_t> in_rotor, const RotationAxis& axis,
                              double rotor_angle) {
    Foam::DynamicList<Foam::point> rotor, stator;
    for (const Foam::fvPatch& patch : mesh.boundary()) {
        if (!Foam::isA<Foam::wallFvPatch>(patch)) continue;
        const Foam::labelUList& cells = patch.faceCells();
        for (Foam::label i = 0; i < patch.size(); ++i) {
            append_triangles(patch.patch()[i], mesh.points(), in_rotor[cells[i]] ? rotor : stator);
        }
    }
    SteelFaces steel{gather(rotor), gather(stator)};
    for (coupling::SteelTriangle& triangle : steel.rotor) {
        for (Vec3* corner : {&triangle.a, &triangle.b, &triangle.c}) *corner = rotate_about(axis, -rotor_angle, *corner);
    }
    return steel;
}

}  // namespace cutterflow::foam
