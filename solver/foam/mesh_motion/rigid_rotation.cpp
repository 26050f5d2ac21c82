#include "solver/foam/mesh_motion/rigid_rotation.hpp"

#include <cmath>

#include "solver/foam/mesh_motion/edit.hpp"
#include "solver/foam/mesh_motion/sliding_interface.hpp"
#include "solver/foam/multigrid/aggregation_multigrid.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "GAMGAgglomeration.H"
#include "bitSet.H"
#include "cyclicAMIFvPatch.H"
#include "cyclicAMIGAMGInterface.H"
#include "dynamicMotionSolverFvMesh.H"
#include "pointIOField.H"
#include "pointMesh.H"
#include "points0MotionSolver.H"
#include "processorFvPatch.H"
#include "quaternion.H"
#include "volFields.H"
#include "wedgePolyPatch.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// x -> centre + R (x - centre).
vector turned_position(const tensor& rotation, const vector& centre, const vector& x) {
    return centre + (rotation & (x - centre));
}

/// integral x x dA [m4] over a face, whose triangles meet in its centre, as OpenFOAM's swept volumes take them.
vector moment_of_area(const face& corners, const pointField& points, const point& centre, const vector& origin) {
    vector moment = Zero;
    forAll(corners, corner) {
        const point &a = points[corners[corner]], &b = points[corners.nextLabel(corner)];
        const vector area = 0.5 * ((b - a) ^ (centre - a));
        moment += ((a + b + centre) / 3.0 - origin) ^ area;
    }
    return moment;
}

template <class Vectors>
void turn_vectors(const Vectors& base, const tensor& rotation, UList<vector>& values) {
    forAll(base.places, i) values[base.places[i]] = rotation & base.values[i];
}

template <class Vectors>
void turn_positions(const Vectors& base, const tensor& rotation, const vector& centre, UList<vector>& values) {
    forAll(base.places, i) values[base.places[i]] = turned_position(rotation, centre, base.values[i]);
}

/// The distance between the cell centres on both sides of a coupled patch, its share on the near side, and what both make of the gradient
/// normal to the face: OpenFOAM's surfaceInterpolation, for one patch.
void compute_coupling(fvMesh& mesh, const fvPatch& patch) {
    const label number = patch.index();
    const auto& side = refCast<const cyclicAMIFvPatch>(patch);
    const cyclicAMIFvPatch& other = side.neighbPatch();
    const vectorField normal(patch.nf());
    const scalarField near(normal & side.coupledFvPatch::delta());
    const scalarField far_distance(other.nf() & other.coupledFvPatch::delta());
    const scalarField far(side.applyLowWeightCorrection() ? side.interpolate(far_distance, scalarField(side.size(), 1.0))
                                                          : side.interpolate(far_distance));
    edit(mesh.weights()).boundaryFieldRef()[number] = far / (near + far);
    const vectorField delta(patch.delta());
    const scalarField coefficient(1.0 / max(normal & delta, 0.05 * mag(delta)));
    edit(mesh.deltaCoeffs()).boundaryFieldRef()[number] = 1.0 / mag(delta);
    edit(mesh.nonOrthDeltaCoeffs()).boundaryFieldRef()[number] = coefficient;
    edit(mesh.nonOrthCorrectionVectors()).boundaryFieldRef()[number] = normal - delta * coefficient;
}

/// Overlaps of a coarse level's interfaces, from those of the next finer one.
void update_overlaps(const lduInterfacePtrsList& fine, const lduInterfacePtrsList& coarse) {
    forAll(coarse, i) {
        if (!coarse.set(i) || !isA<cyclicAMIGAMGInterface>(coarse[i])) continue;
        const auto& side = refCast<const cyclicAMIGAMGInterface>(coarse[i]);
        if (!side.owner()) continue;
        AMIPatchToPatchInterpolation present(refCast<const cyclicAMILduInterface>(fine[i]).AMI(), side.faceRestrictAddressing(),
                                             side.neighbPatch().faceRestrictAddressing());
        AMIPatchToPatchInterpolation& overlap = edit(side.AMI());
        overlap.srcMagSf() = present.srcMagSf();
        overlap.srcAddress().transfer(present.srcAddress());
        overlap.srcWeights().transfer(present.srcWeights());
        overlap.srcWeightsSum().transfer(present.srcWeightsSum());
        overlap.tgtMagSf() = present.tgtMagSf();
        overlap.tgtAddress().transfer(present.tgtAddress());
        overlap.tgtWeights().transfer(present.tgtWeights());
        overlap.tgtWeightsSum().transfer(present.tgtWeightsSum());
        if (overlap.singlePatchProc() != -1) continue;
        edit(overlap.srcMap()).transfer(edit(present.srcMap()));
        edit(overlap.tgtMap()).transfer(edit(present.tgtMap()));
    }
}

/// The clusters of cells of the pressure's multigrid, if it has one: they depend on the angle at which they are looked for.
void make_multigrid(const fvMesh& mesh) {
    const dictionary solver(own_linear_solver(mesh.solverDict("p")));
    const auto is = [](const dictionary& dict, const word& key, const word& value) {
        return dict.lookupOrDefault<word>(key, value) == value;
    };
    const dictionary* multigrid = is(solver, "solver", "GAMG") ? &solver : solver.findDict("preconditioner");
    if (multigrid == nullptr || !is(*multigrid, "preconditioner", "GAMG") || !is(*multigrid, "agglomerator", "faceAreaPair")) return;
    GAMGAgglomeration::New(mesh, *multigrid);
}

/// The multigrid's clusters of cells turn with the mesh. OpenFOAM would look for them anew in each step.
void update_multigrid(fvMesh& mesh) {
    if (!mesh.foundObject<GAMGAgglomeration>(GAMGAgglomeration::typeName)) return;
    const auto& multigrid = mesh.lookupObject<GAMGAgglomeration>(GAMGAgglomeration::typeName);
    if (multigrid.processorAgglomerate()) {
        meshObject::movePoints<lduMesh>(mesh);
        return;
    }
    for (label level = 0; level < multigrid.size(); ++level)
        update_overlaps(multigrid.interfaceLevel(level), multigrid.interfaceLevel(level + 1));
}

}  // namespace

RigidRotation::RigidRotation(dynamicFvMesh& mesh, const MovingZones& zones) : mesh_(mesh), zones_(zones) {
    if (zones.motion.empty()) return;
    bitSet turns(mesh.nCells());
    forAll(mesh.cells(), cell) {
        if (zones.of_cells[static_cast<std::size_t>(cell)] != 0) turns.set(cell);
    }
    bitSet faces(mesh.nFaces()), points(mesh.nPoints());
    forAll(mesh.faceOwner(), face) {
        if (!turns.test(mesh.faceOwner()[face])) continue;
        faces.set(face);
        points.set(mesh.faces()[face]);
    }
    cells_ = turns.sortedToc();
    faces_ = faces.sortedToc();
    points_ = points.sortedToc();
    if (!turns_rigidly(zones.motion.front().axis)) return;
    motion_ = &zones.motion.front();
    // What is computed before the first step, on a mesh read at an angle, must see the overlap that the steps see.
    const double angle = motion_->angle(mesh_.time().value());
    overlap_.emplace(mesh_, zones_, angle);
    overlap_->set(angle);
    mesh_.surfaceInterpolation::movePoints();
}

bool RigidRotation::turns_rigidly(const RotationAxis& axis) const {
    bool rigid = true;
    bitSet turns(mesh_.nCells()), moved(mesh_.nPoints());
    turns.set(cells_);
    moved.set(points_);
    forAll(mesh_.faceOwner(), face) {
        if (turns.test(mesh_.faceOwner()[face])) continue;
        for (const label point : mesh_.faces()[face]) rigid = rigid && !moved.test(point);
    }
    for (const polyPatch& patch : mesh_.boundaryMesh()) rigid = rigid && !isA<wedgePolyPatch>(patch);
    for (direction d = 0; d < vector::nComponents; ++d)
        rigid = rigid && (mesh_.solutionD()[d] == 1 || std::abs(axis.direction[d]) > 1.0 - 1e-12);
    return returnReduce(rigid, andOp<bool>());
}

void RigidRotation::move() {
    if (motion_ == nullptr) {
        mesh_.update();
        return;
    }
    const pointField before(mesh_.points());
    if (!remembered_) {
        mesh_.update();  // what OpenFOAM keeps of a mesh that moves is made here
        const auto& motion = refCast<const dynamicMotionSolverFvMesh>(mesh_).motion();
        mesh_.movePoints(refCast<const points0MotionSolver>(motion).points0());
        mesh_.setV0() = mesh_.V();
        remember();
        make_multigrid(mesh_);
    }
    edit(mesh_.oldPoints()) = before;
    turn(motion_->angle(mesh_.time().value()));
}

void RigidRotation::remember() {
    const auto of = [](const labelUList& places, const UList<vector>& values) {
        return Vectors{labelList(places), vectorField(UIndirectList<vector>(values, places))};
    };
    base_.points = of(points_, mesh_.points());
    base_.face_centres = of(faces_, mesh_.faceCentres());
    base_.face_areas = of(faces_, mesh_.faceAreas());
    base_.cell_centres = of(cells_, mesh_.cellCentres());

    const surfaceVectorField& corrections = mesh_.nonOrthCorrectionVectors();
    DynamicList<label> internal;
    std::vector<DynamicList<label>> of_patch(static_cast<std::size_t>(mesh_.boundary().size()));
    for (const label face : faces_) {
        if (mesh_.isInternalFace(face)) {
            internal.append(face);
        } else {
            const label patch = mesh_.boundaryMesh().patchID()[face - mesh_.nInternalFaces()];
            of_patch[static_cast<std::size_t>(patch)].append(face - mesh_.boundaryMesh()[patch].start());
        }
    }
    base_.corrections = of(internal, corrections);
    for (const fvPatch& patch : mesh_.boundary()) {
        const bool shared = isA<processorFvPatch>(patch);
        const labelList places(shared ? labelList(of_patch[static_cast<std::size_t>(patch.index())]) : labelList());
        base_.patch_corrections.push_back(of(places, corrections.boundaryField()[patch.index()]));
        base_.cell_centres_beyond.push_back(of(places, mesh_.C().boundaryField()[patch.index()]));
    }

    const vector axis = motion_->speed * to_foam(motion_->axis.direction), centre = to_foam(motion_->axis.origin);
    flux_.resize(faces_.size());
    forAll(faces_, i) {
        const label face = faces_[i];
        flux_[i] = axis & moment_of_area(mesh_.faces()[face], mesh_.points(), mesh_.faceCentres()[face], centre);
    }
    overlap_.emplace(mesh_, zones_, 0.0);
    remembered_ = true;
}

void RigidRotation::turn(double angle) {
    const tensor rotation = quaternion(to_foam(motion_->axis.direction), angle).R();
    const vector centre = to_foam(motion_->axis.origin);
    auto& points = edit(static_cast<const pointIOField&>(mesh_.points()));
    turn_positions(base_.points, rotation, centre, points);
    points.writeOpt() = IOobject::AUTO_WRITE;
    points.instance() = mesh_.time().timeName();
    points.eventNo() = mesh_.getEvent();

    turn_positions(base_.face_centres, rotation, centre, edit(mesh_.faceCentres()));
    turn_vectors(base_.face_areas, rotation, edit(mesh_.faceAreas()));
    turn_positions(base_.cell_centres, rotation, centre, edit(mesh_.cellCentres()));
    turn_vectors(base_.corrections, rotation, edit(mesh_.nonOrthCorrectionVectors()).primitiveFieldRef());
    edit(mesh_.bounds()) = boundBox(points);
    overlap_->take();
    edit(mesh_.boundaryMesh()).movePoints(points);
    overlap_->put_back();
    overlap_->set(angle);
    turn_patches(rotation);
    set_mesh_flux();
    couple_interfaces();

    mesh_.clearCellTree();
    meshObject::movePoints<polyMesh>(mesh_);
    meshObject::movePoints<pointMesh>(mesh_);
    meshObject::movePoints<fvMesh>(mesh_);
    update_multigrid(mesh_);
    edit(mesh_.time()).functionObjects().movePoints(mesh_);
    if (volVectorField* velocity = mesh_.getObjectPtr<volVectorField>("U")) velocity->correctBoundaryConditions();
}

/// Coupled patches hold copies of the areas and centres of their faces; those to other ranks the cell centres beyond, too.
void RigidRotation::turn_patches(const tensor& rotation) {
    const vector centre = to_foam(motion_->axis.origin);
    for (const fvPatch& patch : mesh_.boundary()) {
        if (!patch.coupled()) continue;
        const label number = patch.index();
        edit(mesh_.Sf()).boundaryFieldRef()[number] = patch.patchSlice(mesh_.faceAreas());
        edit(mesh_.Cf()).boundaryFieldRef()[number] = patch.patchSlice(mesh_.faceCentres());
        const auto place = static_cast<std::size_t>(number);
        turn_vectors(base_.patch_corrections[place], rotation, edit(mesh_.nonOrthCorrectionVectors()).boundaryFieldRef()[number]);
        turn_positions(base_.cell_centres_beyond[place], rotation, centre, edit(mesh_.C()).boundaryFieldRef()[number]);
    }
}

void RigidRotation::set_mesh_flux() {
    surfaceScalarField& flux = mesh_.setPhi();
    if (flux.timeIndex() != mesh_.time().timeIndex()) flux.oldTime();
    flux.timeIndex() = mesh_.time().timeIndex();
    forAll(faces_, i) {
        const label face = faces_[i];
        if (mesh_.isInternalFace(face)) {
            flux[face] = flux_[i];
            continue;
        }
        const label patch = mesh_.boundaryMesh().patchID()[face - mesh_.nInternalFaces()];
        fvsPatchScalarField& values = flux.boundaryFieldRef()[patch];
        if (!values.empty()) values[face - mesh_.boundaryMesh()[patch].start()] = flux_[i];  // empty patches have no values
    }
}

void RigidRotation::couple_interfaces() {
    for (const label patch : interface_patches(mesh_)) {
        if (mesh_.boundary()[patch].coupled()) compute_coupling(mesh_, mesh_.boundary()[patch]);
    }
}

}  // namespace cutterflow::foam
