#include "solver/foam/single_phase/turbulence_clipping.hpp"

#include <utility>

namespace cutterflow::foam {

using namespace Foam;

TurbulenceClipping::TurbulenceClipping(const fvMesh& mesh, const dictionary& model, const volScalarField* soil)
    : fv::option("clipping", "turbulenceClipping", dictionary(), mesh), soil_(soil) {
    const dictionary& settings = model.subOrEmptyDict("RAS");
    DynamicList<word> fields;
    for (const word& name : {word("k"), word("epsilon"), word("omega"), word("nuTilda")}) {
        if (!mesh.foundObject<volScalarField>(name)) continue;
        fields.append(name);
        const dimensionSet& dimensions = mesh.lookupObject<volScalarField>(name).dimensions();
        const scalar least = name == "nuTilda" ? 0.0 : SMALL;  // OpenFOAM's own
        least_.insert(name, dimensionedScalar::lookupOrDefault(name + "Min", settings, dimensions, least).value());
    }
    fieldNames_.transfer(fields);
    applied_.setSize(fieldNames_.size(), false);
}

void TurbulenceClipping::correct(volScalarField& field) {
    const scalar least = least_[field.name()];
    forAll(field, cell) {
        const bool in_soil = soil_ != nullptr && soil_->primitiveField()[cell] > 0.0;
        if (field[cell] < least && !in_soil) ++count_;
    }
}

label TurbulenceClipping::take_count() {
    return std::exchange(count_, 0);
}

}  // namespace cutterflow::foam
