#include "solver/foam/foam_fluid_engine.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "geometry/base/error.hpp"
#include "solver/foam/mesh_motion/moving_zones.hpp"
#include "solver/foam/session/case_errors.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/session/pstream_communicator.hpp"
#include "solver/foam/single_phase/cutter_fluid.hpp"
#include "solver/foam/single_phase/flow_loads.hpp"
#include "solver/foam/single_phase/patch_roles.hpp"
#include "solver/foam/single_phase/steel_faces.hpp"
#include "solver/foam/single_phase/velocity_sampler.hpp"

#include "fvcAverage.H"
#include "labelIOList.H"
#include "surfaceInterpolate.H"
#include "wallFvPatch.H"
#include "zeroGradientFvPatchFields.H"

namespace cutterflow::foam {
namespace {

std::vector<Vec3> centres_in_zone_frame(const Foam::fvMesh& mesh, const MovingZones& zones) {
    const double time = mesh.time().value();
    std::vector<Vec3> centres(zones.of_cells.size());
    for (std::size_t i = 0; i < centres.size(); ++i) {
        centres[i] = to_vec3(mesh.C()[static_cast<Foam::label>(i)]);
        if (zones.of_cells[i] == coupling::k_still_zone) continue;
        const coupling::ZoneMotion& motion = zones.motion[zones.of_cells[i] - 1u];
        centres[i] = rotate_about(motion.axis, -motion.angle(time), centres[i]);
    }
    return centres;
}

/// Cube root of the cells' volume, averaged with the neighbours' a few times: a jump of cell size becomes a ramp of a few cells. The rotor
/// interface is left out: who is a neighbour there depends on the angle at which the run began or was resumed.
std::vector<double> smooth_cell_sizes(const Foam::fvMesh& mesh) {
    constexpr int passes = 4;
    Foam::volScalarField size(
        Foam::IOobject("cellSize", mesh.time().timeName(), mesh, Foam::IOobject::NO_READ, Foam::IOobject::NO_WRITE, false), mesh,
        Foam::dimensionedScalar(Foam::dimLength, Foam::Zero), Foam::zeroGradientFvPatchScalarField::typeName);
    size.primitiveFieldRef() = Foam::cbrt(mesh.V().field());
    for (int pass = 0; pass < passes; ++pass) {
        size.correctBoundaryConditions();
        Foam::surfaceScalarField of_faces(Foam::linearInterpolate(size));
        for (const Foam::label patch : interface_patches(mesh))
            of_faces.boundaryFieldRef()[patch] = size.boundaryField()[patch].patchInternalField();
        size.primitiveFieldRef() = Foam::fvc::average(of_faces)().primitiveField();
    }
    return std::vector<double>(size.begin(), size.end());
}

/// As decomposePar numbered the cells; one after the other on one rank.
std::vector<std::int64_t> numbers_in_whole_mesh(const Foam::fvMesh& mesh) {
    std::vector<std::int64_t> ids(static_cast<std::size_t>(mesh.nCells()));
    if (!Foam::UPstream::parRun()) {
        std::iota(ids.begin(), ids.end(), std::int64_t{0});
        return ids;
    }
    const Foam::labelIOList addressing(Foam::IOobject("cellProcAddressing", mesh.facesInstance(), Foam::polyMesh::meshSubDir, mesh,
                                                      Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false));
    if (addressing.size() != mesh.nCells())
        throw CaseFileError({addressing.objectPath(),
                             fmt::format("it numbers {} cells, the mesh of this rank has {}", addressing.size(), mesh.nCells()),
                             "decomposePar writes both", "Decompose the case again"});
    std::copy(addressing.begin(), addressing.end(), ids.begin());
    return ids;
}

/// Volume rate swept by the wall faces of each cell, positive out of the cell [m3/s].
void add_up_wall_motion(const Foam::fvMesh& mesh, std::vector<double>& of_cells) {
    std::fill(of_cells.begin(), of_cells.end(), 0.0);
    if (!mesh.moving()) return;
    forAll(mesh.boundary(), patch) {
        if (!Foam::isA<Foam::wallFvPatch>(mesh.boundary()[patch])) continue;
        const Foam::labelUList& cells = mesh.boundary()[patch].faceCells();
        const Foam::scalarField& swept = mesh.phi().boundaryField()[patch];
        forAll(cells, i) of_cells[cells[i]] += swept[i];
    }
}

}  // namespace

struct FoamFluidEngine::Parts {
    Parts(FoamSession& session, bool with_rock, const coupling::PatchSettings& patches, const std::optional<coupling::SoilSettings>& soil)
        : time(session.time()),
          zones(read_moving_zones(session.mesh())),
          roles(find_patch_roles(session.mesh(), patches)),
          fluid(session.mesh(), zones, with_rock ? RockPresence::present : RockPresence::absent, soil),
          centres(centres_in_zone_frame(session.mesh(), zones)),
          volumes(session.mesh().V().begin(), session.mesh().V().end()),
          sizes(smooth_cell_sizes(session.mesh())),
          ids(numbers_in_whole_mesh(session.mesh())),
          wall_retreat(volumes.size(), 0.0) {}

    coupling::Cells cells() const { return {centres, volumes, sizes, zones.of_cells, ids}; }

    const Foam::Time& time;
    MovingZones zones;
    PatchRoles roles;
    CutterFluid fluid;
    std::vector<Vec3> centres;
    std::vector<double> volumes;
    std::vector<double> sizes;
    std::vector<std::int64_t> ids;
    std::vector<double> wall_retreat;
    Foam::vectorField vorticity, stress_divergence;
    PstreamCommunicator communicator;
    SteelFaces steel;  // empty until it is asked for
    std::unique_ptr<VelocitySampler> sampler;
};

FoamFluidEngine::FoamFluidEngine(FoamSession& session, bool with_rock, const coupling::PatchSettings& patches,
                                 const std::optional<coupling::SoilSettings>& soil)
    : parts_(with_case_errors(ThrownErrors::all, [&] { return std::make_unique<Parts>(session, with_rock, patches, soil); })) {
    Parts& p = *parts_;
    p.sampler = std::make_unique<VelocitySampler>(p.fluid.mesh(), p.cells(), p.zones.motion);
}

FoamFluidEngine::~FoamFluidEngine() = default;

coupling::Cells FoamFluidEngine::cells() const {
    return parts_->cells();
}
coupling::Steel FoamFluidEngine::steel() const {
    Parts& p = *parts_;
    if (p.steel.empty()) p.steel = gather_steel_faces(p.fluid.mesh(), p.roles.steel, p.zones, time());
    coupling::Steel steel{{p.steel.begin(), p.steel.end()}};
    if (p.fluid.soil() != nullptr) steel.soil = p.fluid.soil()->surface().triangles();
    return steel;
}
gsl::span<const coupling::ZoneMotion> FoamFluidEngine::moving_zones() const {
    return parts_->zones.motion;
}

coupling::FluidFields FoamFluidEngine::fields() const {
    const CutterFluid& fluid = parts_->fluid;
    return {view(fluid.velocity()), view(fluid.material_acceleration()), view(fluid.void_fraction())};
}

gsl::span<const Vec3> FoamFluidEngine::vorticity() {
    parts_->vorticity = parts_->fluid.vorticity();
    return view(parts_->vorticity);
}
gsl::span<const Vec3> FoamFluidEngine::stress_divergence() {
    parts_->stress_divergence = parts_->fluid.stress_divergence();
    return view(parts_->stress_divergence);
}

double FoamFluidEngine::time() const {
    return parts_->time.value();
}
std::string FoamFluidEngine::time_name() const {
    return parts_->time.timeName();
}
double FoamFluidEngine::time_step() const {
    return parts_->time.deltaTValue();
}
bool FoamFluidEngine::running() {
    return parts_->fluid.running();
}
void FoamFluidEngine::begin_step(double travel_limit, double stop_time) {
    with_case_errors(ThrownErrors::of_file_content, [&] { parts_->fluid.begin_step(travel_limit, stop_time); });
    add_up_wall_motion(parts_->fluid.mesh(), parts_->wall_retreat);
}

gsl::span<const double> FoamFluidEngine::wall_retreat() const {
    return parts_->wall_retreat;
}

void FoamFluidEngine::end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                               const coupling::MomentumExchange& exchange) {
    with_case_errors(ThrownErrors::of_file_content, [&] { parts_->fluid.end_step(void_fraction_old, void_fraction_new, exchange); });
}

void FoamFluidEngine::reset_void_fraction(gsl::span<const double> void_fraction) {
    parts_->fluid.reset_void_fraction(void_fraction);
}
gsl::span<const Vec3> FoamFluidEngine::received() const {
    return view(parts_->fluid.received());
}

void FoamFluidEngine::sample_velocity(gsl::span<const Vec3> points, gsl::span<Vec3> velocity) {
    parts_->sampler->sample(parts_->fluid.velocity(), time(), parts_->communicator, points, velocity);
}

void FoamFluidEngine::watch(const coupling::WatchedPlaces& places) {
    parts_->sampler->watch(places, time(), parts_->communicator);
}

std::vector<double> FoamFluidEngine::watched_means() {
    return parts_->sampler->watched_means(parts_->fluid.velocity(), time(), parts_->communicator);
}

coupling::FluidLoads FoamFluidEngine::loads() {
    return compute_loads(parts_->fluid, parts_->zones, parts_->roles.outlet);
}
bool FoamFluidEngine::write_if_due() {
    return parts_->fluid.write_if_due();
}
void FoamFluidEngine::write_now() {
    parts_->fluid.write_now();
}

std::string FoamFluidEngine::turbulence_model() const {
    return parts_->fluid.turbulence_model();
}
coupling::FluidProperties FoamFluidEngine::fluid_properties() const {
    return {parts_->fluid.density(), parts_->fluid.viscosity()};
}

}  // namespace cutterflow::foam
