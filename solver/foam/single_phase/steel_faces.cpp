#include "solver/foam/single_phase/steel_faces.hpp"

#include "solver/foam/session/foam_conversions.hpp"

#include "ListListOps.H"
#include "Pstream.H"
#include "fvMesh.H"

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

SteelFaces gather_steel_faces(const Foam::fvMesh& mesh, const std::vector<Foam::label>& patches, const MovingZones& zones, double time) {
    std::vector<Foam::DynamicList<Foam::point>> corners(zones.motion.size() + 1);
    for (const Foam::label number : patches) {
        const Foam::fvPatch& patch = mesh.boundary()[number];
        const Foam::labelUList& cells = patch.faceCells();
        for (Foam::label i = 0; i < patch.size(); ++i)
            append_triangles(patch.patch()[i], mesh.points(), corners[zones.of_cells[static_cast<std::size_t>(cells[i])]]);
    }
    SteelFaces steel;
    for (const Foam::DynamicList<Foam::point>& of_zone : corners) steel.push_back(gather(of_zone));
    for (std::size_t k = 0; k < zones.motion.size(); ++k) {
        const coupling::ZoneMotion& motion = zones.motion[k];
        for (coupling::SteelTriangle& triangle : steel[k + 1])
            for (Vec3* corner : {&triangle.a, &triangle.b, &triangle.c}) *corner = rotate_about(motion.axis, -motion.angle(time), *corner);
    }
    return steel;
}

}  // namespace cutterflow::foam
