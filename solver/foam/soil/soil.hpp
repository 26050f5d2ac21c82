#pragma once
/// \file Soil that stands in the water, by penalisation. Only for .cpp files of solver/foam.
#include <memory>
#include <vector>

#include "solver/foam/mesh_motion/moving_zones.hpp"
#include "solver/foam/soil/soil_surface.hpp"
#include "solver/ports/settings.hpp"
#include "solver/space/distance_grid.hpp"

#include "fvMesh.H"
#include "surfaceFields.H"
#include "volFields.H"

namespace cutterflow::foam {

/// Soil whose surface is at rest in the absolute frame, on a mesh whose zones may turn through it. Soil itself moves with the velocity u_s
/// through that surface: where it enters the water, so does its volume. The momentum of a cell with the solid share chi has the sink
///
///   S (u - u_s),   S = max(chi / max(K/nu, (1 - chi + e) dt), nu min(g/w^2, 1/K))                                         [1/s]
///
/// with K the soil's permeability (Darcy's law; 0 = solid), e = 1e-3, w the cell's mean length along the surface's normal and d the
/// distance of its centre outside the surface. chi = 1/2 - d/w within [0, 1] falls over one cell. g = w/d - 1 within [0, 1/e] makes shear
/// flow linear down to the surface: without it water would be at rest at the first centre in the soil.
///
/// With A the momentum's matrix diagonal, sink included, water moves relative to the soil by the share B = 1 - S/A of what it would without
/// soil: cells by theirs, faces by the harmonic mean of both sides' (so that none lets water into soil), and the pressure at a face is that
/// at which both halves between the centres have the same flux.
class Soil {
public:
    Soil(const Foam::fvMesh& mesh, const MovingZones& zones, const coupling::SoilSettings& settings);

    /// To be called after the mesh has moved.
    void follow_mesh();

    /// \param viscosity  of the fluid [m2/s]
    void update_sink(double time_step, double viscosity);

    /// \param diagonal  A of the momentum matrix with the sink in it [1/s] \param velocity  whose conditions tell where the flux is given
    void update_mobility(const Foam::volScalarField& diagonal, const Foam::volVectorField& velocity);

    const Foam::dimensionedVector& velocity() const { return velocity_; }             ///< u_s
    const Foam::volScalarField& share() const { return share_; }                      ///< chi
    const Foam::volScalarField& sink() const { return sink_; }                        ///< S [1/s]
    const Foam::volScalarField& mobility() const { return mobility_; }                ///< B of cells
    const Foam::surfaceScalarField& face_mobility() const { return face_mobility_; }  ///< B of faces; 1 where the flux is given

    /// \param drive  what moves water through faces but the pressure: predicted flux without soil, relative to the soil's, over area and
    /// 1/A [m/s2]
    void set_drive(const Foam::surfaceScalarField& drive) { drive_ == drive; }
    /// Of the pressure, as above.
    Foam::tmp<Foam::surfaceScalarField> at_faces(const Foam::volScalarField& pressure) const;

    /// What the sink takes of the momentum of each cell, over volume and density [m/s2].
    Foam::tmp<Foam::vectorField> resistance(const Foam::volVectorField& velocity) const;
    /// Force of the water on the soil of the whole mesh over density [m4/s2]; collective.
    Foam::vector force(const Foam::volVectorField& velocity) const;

    const coupling::SoilSurface& surface() const { return surface_; }

private:
    template <class Distance>
    void place(Foam::label cell, const Distance& distance, double step);
    double length_along(Foam::label cell, const Vec3& normal) const;
    void make_grid(const coupling::ZoneMotion& motion);

    const Foam::fvMesh& mesh_;
    coupling::SoilSurface surface_;
    double permeability_;  // [m2]
    Foam::dimensionedVector velocity_;
    Foam::labelList turning_;                       // cells
    std::unique_ptr<coupling::DistanceGrid> grid_;  // of the place through which they turn
    Foam::volScalarField share_;
    Foam::scalarField shear_;  // g/w^2 [1/m2]
    Foam::volScalarField sink_;
    Foam::volScalarField mobility_;
    Foam::surfaceScalarField face_mobility_;
    Foam::surfaceScalarField drive_;  // kept in files, for the first predictor after a restart
};

}  // namespace cutterflow::foam
