#include "solver/foam/soil/soil.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "solver/foam/mesh_motion/sliding_interface.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/space/swept_body.hpp"

#include "fvc.H"
#include "snGradScheme.H"
#include "zeroGradientFvPatchFields.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

constexpr double k_leak = 1e-3;  // e: water in solid soil moves by this share of what pressure would move it by in a step
constexpr double k_reach = 3.0;  // in cell sizes, from which on the surface does not matter to a cell

volScalarField number_field(const word& name, const fvMesh& mesh, const dimensionSet& dimensions, scalar value,
                            IOobject::writeOption write) {
    const IOobject object(name, mesh.time().timeName(), mesh, IOobject::NO_READ, write, write == IOobject::AUTO_WRITE);
    return volScalarField(object, mesh, dimensionedScalar(name, dimensions, value), zeroGradientFvPatchScalarField::typeName);
}

/// By central differences. \param step  [m]
template <class Distance>
Vec3 gradient_of(const Distance& distance, const Vec3& point, double step) {
    Vec3 gradient;
    for (int i = 0; i < 3; ++i) {
        const Vec3 ahead = step * Vec3::Unit(i);
        gradient[i] = (distance(point + ahead) - distance(point - ahead)) / (2.0 * step);
    }
    return gradient;
}

}  // namespace

Soil::Soil(const fvMesh& mesh, const MovingZones& zones, const coupling::SoilSettings& settings)
    : mesh_(mesh),
      surface_(read_soil_surface(settings.surface)),
      permeability_(settings.permeability),
      velocity_("soilVelocity", dimVelocity, to_foam(settings.velocity)),
      share_(number_field("soil", mesh, dimless, 0.0, IOobject::AUTO_WRITE)),
      shear_(mesh.nCells(), Zero),
      sink_(number_field("soilSink", mesh, dimless / dimTime, 0.0, IOobject::NO_WRITE)),
      mobility_(number_field("soilMobility", mesh, dimless, 1.0, IOobject::NO_WRITE)),
      face_mobility_("soilFaceMobility", fvc::interpolate(mobility_)),
      drive_(IOobject("soilDrive", mesh.time().timeName(), mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), mesh,
             dimensionedScalar(dimAcceleration, Zero)) {
    DynamicList<label> turning;
    forAll(mesh.C(), cell) {
        if (zones.of_cells[static_cast<std::size_t>(cell)] != coupling::k_still_zone) {
            turning.append(cell);
            continue;
        }
        const double size = std::cbrt(mesh.V()[cell]);
        place(
            cell, [&](const Vec3& point) { return surface_.distance(point, k_reach * size); }, 0.05 * size);
    }
    turning_.transfer(turning);
    if (!zones.motion.empty()) make_grid(zones.motion.front());
    follow_mesh();
    if (gMax(share_.primitiveField()) > 0.0) return;
    throw UserError(
        std::vector<Mistake>{{names::coupling_properties, fmt::format("soil.surface = {}: no cell lies in it", settings.surface.string()),
                              "Soil stands in the mesh, in metres", "Check its place and its unit"}});
}

/// Over the round body that the centres of the turning cells sweep.
void Soil::make_grid(const coupling::ZoneMotion& motion) {
    coupling::SweptBody body;
    double volume = 0.0, largest = 0.0;
    for (const label cell : turning_) {
        body.add(motion.axis, to_vec3(mesh_.C()[cell]));
        volume += mesh_.V()[cell];
        largest = std::max(largest, mesh_.V()[cell]);
    }
    reduce(body.radius, maxOp<scalar>());
    reduce(body.first, minOp<scalar>());
    reduce(body.last, maxOp<scalar>());
    reduce(volume, sumOp<scalar>());
    reduce(largest, maxOp<scalar>());
    const label cells = returnReduce(turning_.size(), sumOp<label>());
    if (cells == 0) return;
    const coupling::Box box = body.box(motion.axis);
    const double reach = k_reach * std::cbrt(largest);
    grid_ = std::make_unique<coupling::DistanceGrid>(box.lower, box.upper, 0.5 * std::cbrt(volume / cells),
                                                     [this, reach](const Vec3& point) { return surface_.distance(point, reach); });
}

/// Volume over the mean area that the cell shows along the normal.
double Soil::length_along(label cell, const Vec3& normal) const {
    const vector n = to_foam(normal.normalized());
    scalar shown = 0.0;
    const auto faces_of = [&](label face) {
        if (mesh_.isInternalFace(face)) return mag(mesh_.Sf()[face] & n);
        const label patch = mesh_.boundaryMesh().whichPatch(face);
        const vectorField& areas = mesh_.Sf().boundaryField()[patch];
        return areas.empty() ? 0.0 : mag(areas[face - mesh_.boundaryMesh()[patch].start()] & n);  // patches of type empty have none
    };
    for (const label face : mesh_.cells()[cell]) shown += 0.5 * faces_of(face);
    return mesh_.V()[cell] / shown;
}

template <class Distance>
void Soil::place(label cell, const Distance& distance, double step) {
    const double size = std::cbrt(mesh_.V()[cell]);
    const Vec3 centre = to_vec3(mesh_.C()[cell]);
    const double d = distance(centre);
    if (std::abs(d) >= k_reach * size) {
        share_[cell] = d < 0.0 ? 1.0 : 0.0;
        shear_[cell] = 0.0;
        return;
    }
    const Vec3 normal = gradient_of(distance, centre, step);
    const double width = normal.norm() > 0.0 ? length_along(cell, normal) : size;
    share_[cell] = std::clamp(0.5 - d / width, 0.0, 1.0);
    shear_[cell] = (d > 0.0 ? std::clamp(width / d - 1.0, 0.0, 1.0 / k_leak) : 1.0 / k_leak) / sqr(width);
}

void Soil::follow_mesh() {
    for (const label cell : turning_)
        place(
            cell, [&](const Vec3& point) { return grid_->at(point); }, 0.5 * grid_->spacing());
    share_.correctBoundaryConditions();
}

void Soil::update_sink(double time_step, double viscosity) {
    forAll(sink_, cell) {
        const double chi = share_[cell];
        const double time = std::max(permeability_ / viscosity, (1.0 - chi + k_leak) * time_step);
        const double shear = permeability_ > 0.0 ? std::min(shear_[cell], 1.0 / permeability_) : shear_[cell];
        sink_[cell] = std::max(chi / time, viscosity * shear);
    }
    sink_.correctBoundaryConditions();
}

/// The two sides of a sliding interface have other faces: the mean of both sides' mobility conserves there, the harmonic one does not.
void Soil::update_mobility(const volScalarField& diagonal, const volVectorField& velocity) {
    const volScalarField resistance(diagonal / (diagonal - sink_));
    mobility_.primitiveFieldRef() = 1.0 / resistance.primitiveField();
    mobility_.correctBoundaryConditions();
    face_mobility_ = 1.0 / fvc::interpolate(resistance);
    const surfaceScalarField mean(fvc::interpolate(mobility_));
    for (const label patch : interface_patches(mesh_)) face_mobility_.boundaryFieldRef()[patch] = mean.boundaryField()[patch];
    forAll(velocity.boundaryField(), patch) if (velocity.boundaryField()[patch].fixesValue()) face_mobility_.boundaryFieldRef()[patch] =
        1.0;
}

tmp<surfaceScalarField> Soil::at_faces(const volScalarField& pressure) const {
    const surfaceScalarField& weight = mesh_.weights();
    const surfaceScalarField& per_distance = mesh_.nonOrthDeltaCoeffs();
    const surfaceScalarField slope(fv::snGradScheme<scalar>::snGrad(mobility_, per_distance, "mobility"));
    const surfaceScalarField jump(slope * weight * (1.0 - weight) / sqr(per_distance));
    return (fvc::interpolate(mobility_ * pressure) - jump * drive_) / fvc::interpolate(mobility_);
}

tmp<vectorField> Soil::resistance(const volVectorField& velocity) const {
    return sink_.primitiveField() * (velocity.primitiveField() - velocity_.value());
}

vector Soil::force(const volVectorField& velocity) const {
    return gSum((mesh_.V().field() * resistance(velocity))());
}

}  // namespace cutterflow::foam
